#include "systems/lighting/environment.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "systems/frame_gpu.hpp"
#include "systems/gpu_scene.hpp"
#include "systems/lighting/chosen_lights.hpp"
#include "systems/lighting/cube_faces.hpp"

namespace petrichor {
namespace {

constexpr float quarter_turn = 1.57079632679f;
constexpr float capture_near_m = 0.1f;
constexpr float eye_level_m = 2.0f;  // of the lowest storey of the grid
constexpr std::size_t most_probes = 12;

void make_targets(EnvironmentProbe& probe) {
  const int width = 6 * ENVIRONMENT_FACE, height = ENVIRONMENT_FACE;
  probe.depth = make_texture_2d(width, height, GL_DEPTH_COMPONENT32F);
  probe.albedo = make_texture_2d(width, height, GL_RGBA8);
  probe.normal = make_texture_2d(width, height, GL_RGBA16);
  probe.emissive = make_texture_2d(width, height, GL_R11F_G11F_B10F);
  probe.radiance = make_texture_2d(width, height, GL_RGBA16F);
  probe.environment = make_texture_2d(ENVIRONMENT_WIDTH, ENVIRONMENT_HEIGHT, GL_RGBA16F);
  clear_texture(probe.environment);
  const std::array<GLuint, 3> colours{probe.albedo.id, probe.normal.id, probe.emissive.id};
  probe.framebuffer = make_framebuffer(colours, probe.depth.id);
}

// A frame's constants of our own while the scope lasts.
struct BorrowedBlock {
  explicit BorrowedBlock(GLuint binding) : binding_(binding) {
    GLint64 value = 0;
    GLint id = 0;
    glGetIntegeri_v(GL_UNIFORM_BUFFER_BINDING, binding, &id);
    id_ = static_cast<GLuint>(id);
    glGetInteger64i_v(GL_UNIFORM_BUFFER_START, binding, &value);
    start_ = static_cast<GLintptr>(value);
    glGetInteger64i_v(GL_UNIFORM_BUFFER_SIZE, binding, &value);
    size_ = static_cast<GLsizeiptr>(value);
  }
  ~BorrowedBlock() {
    if (id_ && size_ > 0) {
      glBindBufferRange(GL_UNIFORM_BUFFER, binding_, id_, start_, size_);
    } else {
      glBindBufferBase(GL_UNIFORM_BUFFER, binding_, id_);
    }
  }
  GLuint binding_, id_ = 0;
  GLintptr start_ = 0;
  GLsizeiptr size_ = 0;
};

void capture(Environment& environment, EnvironmentProbe& probe, Frame& around, const Program& surfaces) {
  const BorrowedBlock constants(FRAME_UNIFORMS_BINDING);
  glBindFramebuffer(GL_FRAMEBUFFER, probe.framebuffer);
  glEnable(GL_DEPTH_TEST);
  glDepthFunc(GL_GREATER);
  glDepthMask(GL_TRUE);
  glDisable(GL_BLEND);
  const float zero[4] = {0, 0, 0, 0};
  glClearNamedFramebufferfv(probe.framebuffer, GL_DEPTH, 0, zero);
  for (GLint i = 0; i < 3; ++i) glClearNamedFramebufferfv(probe.framebuffer, GL_COLOR, i, zero);
  if (around.scene) {
    upload_instances(*around.scene, around);
    surfaces.use();
    for (int face = 0; face < 6; ++face) {
      around.camera.orientation = cube_face_orientation(face);
      finish_frame(around);
      // Each draw reads its own constants: a buffer that a former draw still reads may not be overwritten.
      environment.uniforms = make_buffer(sizeof(FrameUniforms), &around.uniforms);
      glBindBufferRange(GL_UNIFORM_BUFFER, FRAME_UNIFORMS_BINDING, environment.uniforms.id, 0, sizeof(FrameUniforms));
      glViewport(face * ENVIRONMENT_FACE, 0, ENVIRONMENT_FACE, ENVIRONMENT_FACE);
      draw_instances(*around.scene, around, around.uniforms.view_projection, DrawWhat::opaque);
    }
  }
  glDisable(GL_DEPTH_TEST);
  glDisable(GL_CULL_FACE);
  glBindFramebuffer(GL_FRAMEBUFFER, 0);
  probe.captured = true;
  probe.lit = false;
  ++environment.captures;
}

void light_probe(Environment& environment, EnvironmentProbe& probe, const Frame& around,
                 std::span<const int> shadow_slots, const Texture* shadow_atlas, const EnvironmentPrograms& programs) {
  const BorrowedBlock lights(CHOSEN_LIGHTS_BINDING);
  const ChosenLights chosen = choose_lights(around, shadow_slots);
  environment.lights = make_buffer(sizeof chosen, &chosen);
  glBindBufferBase(GL_UNIFORM_BUFFER, CHOSEN_LIGHTS_BINDING, environment.lights.id);

  glMemoryBarrier(GL_TEXTURE_FETCH_BARRIER_BIT);
  const GLuint inputs[] = {probe.depth.id, probe.albedo.id, probe.normal.id, probe.emissive.id};
  glBindTextures(0, 4, inputs);
  if (shadow_atlas) glBindTextureUnit(6, shadow_atlas->id);
  glBindImageTexture(0, probe.radiance.id, 0, GL_FALSE, 0, GL_WRITE_ONLY, GL_RGBA16F);
  programs.light.use();
  programs.light.set("near_m", capture_near_m);
  programs.light.dispatch(6 * ENVIRONMENT_FACE, ENVIRONMENT_FACE);
  glMemoryBarrier(GL_TEXTURE_FETCH_BARRIER_BIT);

  glBindTextureUnit(0, probe.radiance.id);
  glBindImageTexture(0, probe.environment.id, 0, GL_FALSE, 0, GL_WRITE_ONLY, GL_RGBA16F);
  programs.filter.use();
  programs.filter.dispatch(ENVIRONMENT_LEVELS * ENVIRONMENT_TILE, ENVIRONMENT_TILE);
  programs.harmonics.use();
  glDispatchCompute(9, 1, 1);
  glMemoryBarrier(GL_SHADER_IMAGE_ACCESS_BARRIER_BIT);
  glBindImageTexture(0, probe.environment.id, 0, GL_FALSE, 0, GL_READ_WRITE, GL_RGBA16F);
  programs.diffuse.use();
  programs.diffuse.dispatch(ENVIRONMENT_TILE, ENVIRONMENT_TILE);
  glMemoryBarrier(GL_TEXTURE_FETCH_BARRIER_BIT);
  probe.lit = true;
}

EnvironmentProbe& find_probe(Environment& environment, const glm::ivec3& cell) {
  auto& probes = environment.probes;
  auto found = std::find_if(probes.begin(), probes.end(), [&](const auto& p) { return p.cell == cell; });
  if (found == probes.end()) {
    if (probes.size() < most_probes) {
      probes.emplace_back();
      make_targets(probes.back());
      found = probes.end() - 1;
    } else {
      found = std::min_element(probes.begin(), probes.end(),
                               [](const auto& a, const auto& b) { return a.last_used < b.last_used; });
    }
    found->cell = cell;
    found->captured = found->lit = false;
  }
  found->last_used = ++environment.clock;
  return *found;
}

}  // namespace

std::vector<EnvironmentCorner> environment_corners(const glm::dvec3& camera_m, float spacing_m) {
  const double x = camera_m.x / spacing_m, z = camera_m.z / spacing_m;
  const int x0 = static_cast<int>(std::floor(x)), z0 = static_cast<int>(std::floor(z));
  const int y = static_cast<int>(std::round((camera_m.y - eye_level_m) / spacing_m));
  // A plateau round each place, so that standing near one costs one capture.
  const auto share = [](double f) { return static_cast<float>(std::clamp((f - 0.25) / 0.5, 0.0, 1.0)); };
  const float fx = share(x - x0), fz = share(z - z0);
  std::vector<EnvironmentCorner> corners;
  for (int i = 0; i < 4; ++i) {
    const float weight = (i & 1 ? fx : 1.0f - fx) * (i & 2 ? fz : 1.0f - fz);
    if (weight > 0.0f) corners.push_back({{x0 + (i & 1), y, z0 + (i >> 1)}, weight});
  }
  return corners;
}

glm::dvec3 environment_place_m(const glm::ivec3& cell, float spacing_m) {
  return glm::dvec3(cell) * static_cast<double>(spacing_m) + glm::dvec3(0.0, eye_level_m, 0.0);
}

void update_environment(Environment& environment, const Frame& frame, float spacing_m, const Texture* shadow_atlas,
                        std::span<const int> shadow_slots, const EnvironmentPrograms& programs, const Texture& target) {
  if (environment.geometry_version != frame.geometry_version || environment.scene != frame.scene) {
    for (EnvironmentProbe& probe : environment.probes) probe.captured = false;
    environment.geometry_version = frame.geometry_version;
    environment.scene = frame.scene;
  }
  if (environment.shadows != (shadow_atlas != nullptr)) {
    for (EnvironmentProbe& probe : environment.probes) probe.lit = false;
    environment.shadows = shadow_atlas != nullptr;
  }
  const std::uint64_t lighting = lighting_hash(frame);

  const std::vector<EnvironmentCorner> corners = environment_corners(frame.camera.position_m, spacing_m);
  Frame around;
  bool moved_instances = false;
  std::array<GLuint, 4> textures{};
  glm::vec4 weights(0.0f);
  for (std::size_t i = 0; i < corners.size(); ++i) {
    EnvironmentProbe& probe = find_probe(environment, corners[i].cell);
    if (!probe.captured || !probe.lit || probe.lighting != lighting) {
      if (around.width == 0) {
        around.scene = frame.scene;
        around.instances = frame.instances;
        around.lights = frame.lights;
        around.sky = frame.sky;
        around.width = around.height = ENVIRONMENT_FACE;
        around.camera.vertical_fov_rad = quarter_turn;
        around.camera.near_m = capture_near_m;
      }
      around.camera.position_m = environment_place_m(corners[i].cell, spacing_m);
      if (!probe.captured) {
        capture(environment, probe, around, programs.surfaces);
        moved_instances = true;
      }
      light_probe(environment, probe, around, shadow_slots, shadow_atlas, programs);
      probe.lighting = lighting;
    }
    textures[i] = probe.environment.id;
    weights[static_cast<int>(i)] = corners[i].weight;
  }
  for (std::size_t i = corners.size(); i < 4; ++i) textures[i] = textures[0];
  if (moved_instances && frame.scene) upload_instances(*frame.scene, frame);

  glBindTextures(0, 4, textures.data());
  glBindImageTexture(0, target.id, 0, GL_FALSE, 0, GL_WRITE_ONLY, GL_RGBA16F);
  programs.blend.use();
  programs.blend.set("weights", weights);
  programs.blend.dispatch(ENVIRONMENT_WIDTH, ENVIRONMENT_HEIGHT);
}

}  // namespace petrichor
