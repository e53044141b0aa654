#include "systems/splash/crown.hpp"

#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>

#include "engine/core/random.hpp"

namespace petrichor {
namespace {

constexpr float tau = 6.28318531f;
constexpr int jets_of_film = 14, jets_of_corona = 22;

// Transmittance is what is summed: opacities of what overlaps multiply.
struct Canvas {
  float sine, cosine;  // of the elevation
  std::vector<float> clear = std::vector<float>(CROWN_SIDE * CROWN_SIDE, 1.0f);
  std::vector<float> weight = std::vector<float>(CROWN_SIDE * CROWN_SIDE, 0.0f);
  std::vector<glm::vec3> shown = std::vector<glm::vec3>(CROWN_SIDE * CROWN_SIDE, glm::vec3(0.0f));

  // Of the picture's axes: right, up, towards the eye. The eye looks along -z of the surface's frame, y is its normal.
  glm::vec3 seen(const glm::vec3& p) const { return {p.x, p.y * cosine - p.z * sine, p.y * sine + p.z * cosine}; }
  void cover(int x, int y, float opacity, const glm::vec3& normal) {
    if (x < 0 || y < 0 || x >= CROWN_SIDE || y >= CROWN_SIDE || !(opacity > 0.0f)) return;
    const std::size_t at = std::size_t(y) * CROWN_SIDE + x;
    const float facing = std::clamp(std::abs(normal.z), 0.0f, 1.0f);
    const float fresnel = 0.95f * std::pow(1.0f - facing, 4.0f) + 0.05f;
    opacity = std::min(opacity, 0.995f);
    clear[at] *= 1.0f - opacity;
    weight[at] += opacity;
    shown[at] += opacity * glm::vec3(fresnel, 0.5f + 0.5f * normal.x, 0.5f + 0.5f * normal.y);
  }
  static float texels(float v) { return (v / CROWN_REACH * 0.5f + 0.5f) * CROWN_SIDE; }

  void ball(const glm::vec3& place, float radius) {
    const glm::vec3 p = seen(place);
    // What flies out of the picture is left to the droplets.
    if (std::max(std::abs(p.x), std::abs(p.y)) > CROWN_REACH - 0.1f - radius) return;
    const float x = texels(p.x), y = texels(p.y), r = radius / CROWN_REACH * 0.5f * CROWN_SIDE;
    // Smaller than a texel: as much of it as the ball covers.
    const float grown = std::max(r, 0.6f), kept = r * r / (grown * grown);
    for (int j = int(std::floor(y - grown - 0.5f)); j <= int(y + grown + 0.5f); ++j)
      for (int i = int(std::floor(x - grown - 0.5f)); i <= int(x + grown + 0.5f); ++i) {
        const glm::vec2 d = (glm::vec2(i, j) + 0.5f - glm::vec2(x, y)) / grown;
        const float away = glm::length(d), edge = std::clamp((1.0f - away) * grown + 0.5f, 0.0f, 1.0f);
        if (edge <= 0.0f) continue;
        const glm::vec2 inside = away > 0.98f ? d / away * 0.98f : d;
        cover(i, j, kept * edge, {inside, std::sqrt(1.0f - glm::dot(inside, inside))});
      }
  }
  // A piece of sheet: optical depth per texel by its area, so that it thickens where it is seen edge on.
  void piece(const glm::vec3& place, const glm::vec3& normal, float area, float depth) {
    const glm::vec3 p = seen(place), n = seen(normal);
    const float texel = 2.0f * CROWN_REACH / CROWN_SIDE;
    const float optical = depth * area / (texel * texel);
    const float x = texels(p.x) - 0.5f, y = texels(p.y) - 0.5f;
    const int i = int(std::floor(x)), j = int(std::floor(y));
    const float u = x - i, v = y - j;
    for (int k = 0; k < 4; ++k) {
      const float share = (k & 1 ? u : 1 - u) * (k & 2 ? v : 1 - v);
      cover(i + (k & 1), j + (k >> 1), 1.0f - std::exp(-optical * share), n);
    }
  }
};

float rand_of(std::uint32_t a, std::uint32_t b) {
  return random_float(glm::uvec4(a, b, 0xc0fe, 17));
}

float smooth(float low, float high, float x) {
  const float t = std::clamp((x - low) / (high - low), 0.0f, 1.0f);
  return t * t * (3.0f - 2.0f * t);
}

// The rim's waves, which the jets grow from.
float rim_wave(bool film, int take, float turn) {
  turn += 1.9f * static_cast<float>(take);
  const float jets = film ? jets_of_film : jets_of_corona;
  return 0.25f * std::sin(turn * jets) + 0.45f * std::sin(turn * 5.0f + 1.3f) + 0.5f * std::sin(turn * 2.0f + 0.4f) +
         0.35f * std::sin(turn * 9.0f + 2.6f);
}

}  // namespace

CrownShape crown_shape(bool film, float phase) {
  const float grows = std::sqrt(std::clamp(phase / 0.35f, 0.0f, 1.0f));
  const float up = phase < 0.4f ? std::sin(0.25f * tau * phase / 0.4f) : std::cos(0.25f * tau * (phase - 0.4f) / 0.6f);
  return {grows * (1.0f + 0.1f * std::max(phase - 0.35f, 0.0f)) / 1.065f, (film ? 0.55f : 0.18f) * std::max(up, 0.0f),
          1.0f - smooth(0.5f, 0.85f, phase)};
}

std::vector<float> crown_picture(bool film, float elevation_deg, float phase, int take) {
  const float elevation = elevation_deg * tau / 360.0f;
  Canvas canvas{std::sin(elevation), std::cos(elevation)};
  const CrownShape now = crown_shape(film, phase);
  // The wall leans out by a fifth of its height.
  constexpr float lean = 0.22f;
  const int around = 192, upwards = std::max(4, int(now.height * 40.0f));
  for (int a = 0; a < around; ++a) {
    const float turn = tau * (a + 0.5f) / around;
    const glm::vec3 out(std::cos(turn), 0.0f, std::sin(turn));
    const float wave = rim_wave(film, take, turn);
    const float high = now.height * (1.0f + 0.16f * wave);
    const float ring = now.radius * (1.0f + 0.03f * std::sin(turn * 3.0f));
    for (int k = 0; k < upwards; ++k) {
      const float s = (k + 0.5f) / upwards;
      const glm::vec3 place = out * (ring + lean * high * s * s) + glm::vec3(0, high * s, 0);
      const glm::vec3 normal = glm::normalize(out - glm::vec3(0, 2.0f * lean * s, 0));
      const float area = tau / around * ring * high / upwards;
      // Clear water: it bends light where it is not flat, below at its foot and above where it gathers to the rim.
      const float bends = 0.07f + 0.3f * std::pow(1.0f - s, 6.0f) + 0.22f * s * s * s + 0.08f * std::max(wave, 0.0f);
      canvas.piece(place, normal, area, now.sheet * bends * (film ? 1.0f : 0.5f));
    }
    // Its foot, a raised ring on the surface, flattens; on a film it runs on as the first wave.
    const float runs = film ? 0.4f * std::max(phase - 0.4f, 0.0f) : 0.0f;
    canvas.ball(out * (ring + runs) * (1.0f + 0.01f * wave) + glm::vec3(0, 0.01f, 0),
                0.018f * (1.0f - 0.8f * phase) * (film ? 1.0f : 0.4f));
    // The rim tears where the sheet does.
    const float rim = (film ? 0.022f : 0.014f) * (0.75f + 0.25f * wave) * std::sqrt(now.sheet);
    if (rim > 0.004f) canvas.ball(out * (ring + lean * high) + glm::vec3(0, high, 0), rim);
  }
  // Jets, and their drops, which go on on their own after they have left.
  const int jets = film ? jets_of_film : jets_of_corona;
  for (int j = 0; j < jets; ++j) {
    const std::uint32_t key = std::uint32_t(j) + (film ? 0u : 100u) + 1000u * std::uint32_t(take);
    const float turn = tau * (j + 0.25f + 1.3f * (rand_of(key, 1) - 0.5f)) / jets;
    const glm::vec3 out(std::cos(turn), 0.0f, std::sin(turn));
    const float chance = rand_of(key, 2), strength = 0.3f + 1.25f * chance * chance;
    const float high = now.height * (1.0f + 0.16f * rim_wave(film, take, turn));
    const glm::vec3 foot = out * (now.radius + lean * high) + glm::vec3(0, high, 0);
    const glm::vec3 way =
        glm::normalize(out * ((film ? 0.35f : 0.7f) + 0.5f * rand_of(key, 11)) + glm::vec3(0, film ? 0.85f : 0.7f, 0) +
                       0.3f * (rand_of(key, 12) - 0.5f) * glm::vec3(-out.z, 0, out.x));
    const float length =
        (film ? 0.26f : 0.3f) * strength * smooth(0.04f, 0.3f, phase) * (1.0f - smooth(0.55f, 0.85f, phase));
    constexpr int beads = 9;
    for (int b = 0; b < beads && length > 0.01f; ++b) {
      const float s = (b + 0.5f) / beads;
      canvas.ball(foot + way * (length * s), 0.024f * (1.0f - 0.65f * s) * (0.55f + 0.45f * strength));
    }
    for (int d = 0; d < 2; ++d) {
      const float leaves = 0.22f + 0.28f * d + 0.1f * rand_of(key, 3 + d);
      const float since = phase - leaves;
      if (since < 0.0f) {
        if (d == 0 && length > 0.02f) canvas.ball(foot + way * length, 0.03f * std::sqrt(strength));  // the jet's head
        continue;
      }
      const CrownShape then = crown_shape(film, leaves);
      const glm::vec3 start =
          out * (then.radius + lean * then.height) + way * (0.24f * strength) + glm::vec3(0, then.height, 0);
      const glm::vec3 place = start + way * (0.7f * strength * since) - glm::vec3(0, 1.3f * since * since, 0);
      if (place.y > 0.0f) canvas.ball(place, 0.03f * (0.6f + 0.5f * rand_of(key, 7 + d)));
    }
  }
  std::vector<float> picture(std::size_t(CROWN_SIDE) * CROWN_SIDE * 4);
  for (std::size_t i = 0; i < canvas.clear.size(); ++i) {
    const float opacity = 1.0f - canvas.clear[i];
    picture[4 * i] = opacity;
    // Weighted means of what overlaps, times the opacity of all.
    const float share = canvas.weight[i] > 0.0f ? opacity / canvas.weight[i] : 0.0f;
    for (int c = 0; c < 3; ++c) picture[4 * i + 1 + c] = canvas.shown[i][c] * share;
  }
  return picture;
}

std::vector<std::uint16_t> bake_crowns() {
  constexpr int samples = 3;  // of each phase
  constexpr std::size_t texels = std::size_t(CROWN_SIDE) * CROWN_SIDE * 4;
  std::vector<std::uint16_t> all(texels * CROWN_PHASES * CROWN_VIEWS * CROWN_KINDS);
  std::uint16_t* out = all.data();
  for (int kind = 0; kind < CROWN_KINDS; ++kind)
    for (const float view : crown_views_deg) {
      std::vector<double> sum(texels, 0.0);
      for (int p = 0; p < CROWN_PHASES; ++p) {
        for (int s = 0; s < samples; ++s) {
          const float phase = (p + (s + 0.5f) / samples) / CROWN_PHASES;
          const std::vector<float> picture = crown_picture(kind < CROWN_TAKES, view, phase, kind % CROWN_TAKES);
          for (std::size_t i = 0; i < texels; ++i) sum[i] += picture[i] / (samples * CROWN_PHASES);
        }
        for (std::size_t i = 0; i < texels; ++i)
          *out++ = static_cast<std::uint16_t>(std::lround(std::min(sum[i], 1.0) * 65535.0));
      }
    }
  return all;
}

}  // namespace petrichor
