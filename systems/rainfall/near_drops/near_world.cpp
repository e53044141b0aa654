#include "systems/rainfall/near_drops/near_world.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <numeric>
#include <vector>

#include "systems/frame_gpu.hpp"
#include "systems/gpu_scene.hpp"
#include "systems/rainfall/near_drops/near_shared.h"

namespace petrichor {
namespace {

constexpr float capture_near_m = 0.1f;
constexpr float brightest_cd_m2 = 30.0f;  // as the environment of the lighting: lamps shine through their intensities

// +x -x +y -y +z -z, right-handed, as octahedral.glsl's face_from_direction reads them.
glm::quat face_orientation(int face) {
  static constexpr glm::vec3 x{1, 0, 0}, y{0, 1, 0}, z{0, 0, 1};
  const std::array<glm::mat3, 6> axes{glm::mat3(z, y, -x), glm::mat3(-z, y, x),  glm::mat3(x, z, -y),
                                      glm::mat3(x, -z, y), glm::mat3(-x, y, -z), glm::mat3(x, y, z)};
  return glm::quat_cast(axes[static_cast<std::size_t>(face)]);
}

void make_targets(NearWorld& world, int face) {
  world.face_texels = face;
  world.cube = make_texture_cube(face, GL_RGBA16F, full_mip_levels(face, face));
  world.depth = make_texture_2d(6 * face, face, GL_DEPTH_COMPONENT32F);
  world.albedo = make_texture_2d(6 * face, face, GL_RGBA8);
  world.normal = make_texture_2d(6 * face, face, GL_RGBA16);
  world.emissive = make_texture_2d(6 * face, face, GL_R11F_G11F_B10F);
  const std::array<GLuint, 3> colours{world.albedo.id, world.normal.id, world.emissive.id};
  world.framebuffer = make_framebuffer(colours, world.depth.id);
  world.captured = world.lit = false;
}

// The frame's constants are the capture's own while it is drawn and lit.
struct BorrowedConstants {
  BorrowedConstants() {
    glGetIntegeri_v(GL_UNIFORM_BUFFER_BINDING, FRAME_UNIFORMS_BINDING, &id_);
    glGetInteger64i_v(GL_UNIFORM_BUFFER_START, FRAME_UNIFORMS_BINDING, &start_);
    glGetInteger64i_v(GL_UNIFORM_BUFFER_SIZE, FRAME_UNIFORMS_BINDING, &size_);
  }
  ~BorrowedConstants() {
    if (id_ != 0 && size_ > 0)
      glBindBufferRange(GL_UNIFORM_BUFFER, FRAME_UNIFORMS_BINDING, static_cast<GLuint>(id_),
                        static_cast<GLintptr>(start_), static_cast<GLsizeiptr>(size_));
    else
      glBindBufferBase(GL_UNIFORM_BUFFER, FRAME_UNIFORMS_BINDING, static_cast<GLuint>(id_));
  }
  GLint id_ = 0;
  GLint64 start_ = 0, size_ = 0;
};

void capture(NearWorld& world, const Frame& frame, const Program& surfaces) {
  glBindFramebuffer(GL_FRAMEBUFFER, world.framebuffer);
  // By textures: glClearNamedFramebuffer is slow on some drivers.
  clear_texture(world.depth);
  clear_texture(world.albedo);
  clear_texture(world.normal);
  clear_texture(world.emissive);
  if (frame.scene) {
    const BorrowedConstants constants;
    Frame around;
    around.scene = frame.scene;
    around.instances = frame.instances;
    around.sky = frame.sky;
    around.width = around.height = world.face_texels;
    around.camera.vertical_fov_rad = 1.57079632679f;
    around.camera.near_m = capture_near_m;
    around.camera.exposure_ev100 = frame.camera.exposure_ev100;
    around.camera.position_m = world.place_m;
    glEnable(GL_DEPTH_TEST);
    glDepthFunc(GL_GREATER);
    glDepthMask(GL_TRUE);
    glDisable(GL_BLEND);
    upload_instances(*around.scene, around);
    surfaces.use();
    for (int face = 0; face < 6; ++face) {
      around.camera.orientation = face_orientation(face);
      finish_frame(around);
      // Each draw reads its own constants: a buffer that a former draw still reads may not be overwritten.
      world.uniforms = make_buffer(sizeof(FrameUniforms), &around.uniforms);
      glBindBufferRange(GL_UNIFORM_BUFFER, FRAME_UNIFORMS_BINDING, world.uniforms.id, 0, sizeof(FrameUniforms));
      glViewport(face * world.face_texels, 0, world.face_texels, world.face_texels);
      draw_instances(*around.scene, around, around.uniforms.view_projection, DrawWhat::opaque);
    }
    glDisable(GL_DEPTH_TEST);
    glDisable(GL_CULL_FACE);
    upload_instances(*frame.scene, frame);
  }
  glBindFramebuffer(GL_FRAMEBUFFER, 0);
  world.captured = true;
  world.lit = false;
  ++world.captures;
}

// The lamps that count most at the capture. They do not depend on where in the step the camera is.
std::vector<NearLampGpu> lamps_at(const Frame& frame, const glm::dvec3& place_m) {
  std::vector<std::pair<float, std::size_t>> order;
  for (std::size_t i = 0; i < frame.lights.size(); ++i) {
    const FrameLight& light = frame.lights[i];
    const float strongest = std::max({light.intensity.x, light.intensity.y, light.intensity.z});
    if (!(strongest > 0.0f)) continue;
    const glm::vec3 away(glm::dvec3(light.position_m) - place_m);
    const bool directional = light.kind == LIGHT_DIRECTIONAL;
    order.emplace_back(directional ? 1e30f : strongest / std::max(glm::dot(away, away), 1.0f), i);
  }
  std::stable_sort(order.begin(), order.end(), [](const auto& a, const auto& b) { return a.first > b.first; });
  if (order.size() > NEAR_LAMPS) order.resize(NEAR_LAMPS);
  std::vector<NearLampGpu> lamps;
  for (const auto& [weight, i] : order) {
    const FrameLight& light = frame.lights[i];
    const bool spot = light.kind == LIGHT_SPOT;
    const float inner = std::cos(std::min(light.inner_cone_rad, light.outer_cone_rad));
    const float outer = std::cos(light.outer_cone_rad);
    // KHR_lights_punctual, "Inner and Outer Cone Angles".
    const float scale = spot ? 1.0f / std::max(0.001f, inner - outer) : 0.0f;
    lamps.push_back({glm::vec4(glm::vec3(glm::dvec3(light.position_m) - place_m),
                               light_range_m(light, frame.camera.exposure_ev100)),
                     glm::vec4(light.intensity, std::max(light.source_radius_m, 0.005f)),
                     glm::vec4(light.direction, static_cast<float>(light.kind)),
                     glm::vec4(scale, spot ? -outer * scale : 1.0f, -1.0f, light.lights_rain ? 1.0f : 0.0f)});
  }
  return lamps;
}

// Of all that the light of the capture depends on, so that a frame is the same drawn alone: lamps' ranges follow the
// exposure, and which lamps have shadows the camera's place on a grid of 8 m (lighting/chosen_lights.cpp).
std::uint64_t lighting_of(const Frame& frame, bool shadows) {
  std::uint64_t hash = 14695981039346656037ull;  // Fowler, Noll, Vo, 64 bits, 1a
  const auto add = [&](float v) { hash = (hash ^ std::bit_cast<std::uint32_t>(v)) * 1099511628211ull; };
  const auto add3 = [&](const glm::vec3& v) { add(v.x), add(v.y), add(v.z); };
  for (const FrameLight& l : frame.lights) {
    add3(l.position_m), add3(l.direction), add3(l.intensity);
    add(light_range_m(l, frame.camera.exposure_ev100)), add(l.inner_cone_rad), add(l.outer_cone_rad),
        add(l.source_radius_m);
    add(static_cast<float>(l.kind)), add(l.lights_rain ? 1.0f : 0.0f);
    add(shadows && l.casts_shadow ? 1.0f : 0.0f);
  }
  add3(frame.sky.zenith_cd_m2), add3(frame.sky.horizon_cd_m2), add(frame.sky.glow_height);
  add(shadows ? 1.0f : 0.0f);
  if (shadows) add3(glm::vec3(glm::round(frame.camera.position_m / 8.0)));
  return hash;
}

void light(NearWorld& world, const Frame& frame, const Texture* shadow_atlas, const Program& program) {
  const std::vector<NearLampGpu> lamps = lamps_at(frame, world.place_m);
  upload(world.lamps, std::span<const NearLampGpu>(lamps));
  if (lamps.empty()) upload(world.lamps, std::span<const NearLampGpu>(std::vector<NearLampGpu>(1)));
  glMemoryBarrier(GL_TEXTURE_FETCH_BARRIER_BIT);
  const GLuint inputs[] = {world.depth.id, world.albedo.id, world.normal.id, world.emissive.id};
  glBindTextures(0, 4, inputs);
  if (shadow_atlas) glBindTextureUnit(6, shadow_atlas->id);
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, NEAR_LAMPS_BINDING, world.lamps.id);
  program.use();
  program.set("lamp_count", static_cast<int>(lamps.size()));
  program.set("near_m", capture_near_m);
  program.set("brightest", brightest_cd_m2);
  program.set("capture_offset", glm::vec3(world.place_m - frame.camera.position_m));
  program.set("capture_texels", world.face_texels);
  const auto write_level = [&](int level, const glm::vec3& all_round, bool lamp_discs) {
    const int face = std::max(1, world.face_texels >> level);
    program.set("face_texels", face);
    program.set("all_round", all_round);
    program.set("lamp_discs", int(lamp_discs));
    glBindImageTexture(0, world.cube.id, level, GL_TRUE, 0, GL_WRITE_ONLY, GL_RGBA16F);
    program.dispatch(face, face, 6);
    glMemoryBarrier(GL_TEXTURE_FETCH_BARRIER_BIT | GL_TEXTURE_UPDATE_BARRIER_BIT | GL_FRAMEBUFFER_BARRIER_BIT);
  };
  // First roughly: what falls on surfaces from all round is the mean of what lamps make of them and of the sky.
  glm::vec3 all_round(0.0f);
  if (frame.scene) {
    const int level = std::min(3, world.cube.levels - 1), face = std::max(1, world.face_texels >> level);
    write_level(level, all_round, false);
    std::vector<glm::vec4> texels(std::size_t(6) * face * face);
    glGetTextureImage(world.cube.id, level, GL_RGBA, GL_FLOAT, static_cast<GLsizei>(texels.size() * sizeof(glm::vec4)),
                      texels.data());
    for (const glm::vec4& t : texels) all_round += glm::vec3(t) / static_cast<float>(texels.size());
  }
  write_level(0, all_round, true);
  glGenerateTextureMipmap(world.cube.id);
  world.lit = true;
  ++world.relights;
}

}  // namespace

void update_near_world(NearWorld& world, const Frame& frame, int face_texels, float step_m, const Texture* shadow_atlas,
                       const NearWorldPrograms& programs) {
  if (world.face_texels != face_texels) make_targets(world, face_texels);
  const glm::i64vec3 cell(glm::round(frame.camera.position_m / double(step_m)));
  if (!world.captured || cell != world.cell || step_m != world.step_m ||
      world.exposure_ev100 != frame.camera.exposure_ev100 || world.geometry_version != frame.geometry_version ||
      world.scene != frame.scene) {
    world.cell = cell;
    world.step_m = step_m;
    world.exposure_ev100 = frame.camera.exposure_ev100;
    world.place_m = glm::dvec3(cell) * double(step_m);
    world.geometry_version = frame.geometry_version;
    world.scene = frame.scene;
    capture(world, frame, programs.surfaces);
  }
  const std::uint64_t lighting = lighting_of(frame, shadow_atlas != nullptr);
  if (world.lit && world.lighting == lighting) return;
  world.lighting = lighting;
  light(world, frame, shadow_atlas, programs.light);
}

}  // namespace petrichor
