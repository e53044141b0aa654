#include "systems/lighting/capture.hpp"

#include <array>

#include "systems/borrowed_block.hpp"
#include "systems/frame_gpu.hpp"
#include "systems/gpu_scene.hpp"
#include "systems/lighting/chosen_lights.hpp"
#include "systems/lighting/cube_faces.hpp"

namespace petrichor {
namespace {

constexpr float quarter_turn = 1.57079632679f;
constexpr float capture_near_m = 0.1f;

}  // namespace

void make_probe_targets(EnvironmentProbe& probe) {
  const int width = 6 * ENVIRONMENT_FACE, height = ENVIRONMENT_FACE;
  probe.depth = make_texture_2d(width, height, GL_DEPTH_COMPONENT32F);
  probe.albedo = make_texture_2d(width, height, GL_RGBA8);
  probe.normal = make_texture_2d(width, height, GL_RGBA16);
  probe.emissive = make_texture_2d(width, height, GL_R11F_G11F_B10F);
  probe.radiance = make_texture_2d(width, height, GL_RGBA16F);
  probe.environment = make_texture_2d(ENVIRONMENT_WIDTH, ENVIRONMENT_HEIGHT, GL_RGBA16F);
  clear_texture(probe.environment);
  probe.own_light = make_texture_2d(width, height, GL_R16F);
  probe.own_environment = make_texture_2d(ENVIRONMENT_LEVELS * ENVIRONMENT_TILE, ENVIRONMENT_TILE, GL_R16F);
  clear_texture(probe.own_environment);
  const std::array<GLuint, 3> colours{probe.albedo.id, probe.normal.id, probe.emissive.id};
  probe.framebuffer = make_framebuffer(colours, probe.depth.id);
}

Frame frame_around(const Frame& frame) {
  Frame around;
  around.scene = frame.scene;
  around.lights = frame.lights;
  around.sky = frame.sky;
  around.width = around.height = ENVIRONMENT_FACE;
  around.camera.vertical_fov_rad = quarter_turn;
  around.camera.near_m = capture_near_m;
  return around;
}

void capture_faces(EnvironmentProbe& probe, Frame& around, const Program& surfaces) {
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
      const Buffer uniforms = make_buffer(sizeof(FrameUniforms), &around.uniforms);
      glBindBufferRange(GL_UNIFORM_BUFFER, FRAME_UNIFORMS_BINDING, uniforms.id, 0, sizeof(FrameUniforms));
      glViewport(face * ENVIRONMENT_FACE, 0, ENVIRONMENT_FACE, ENVIRONMENT_FACE);
      draw_instances(*around.scene, around, around.uniforms.view_projection, DrawWhat::opaque);
    }
  }
  glDisable(GL_DEPTH_TEST);
  glDisable(GL_CULL_FACE);
  glBindFramebuffer(GL_FRAMEBUFFER, 0);
  probe.captured = true;
  probe.lit = false;
}

void light_faces(EnvironmentProbe& probe, const Frame& around, std::span<const int> shadow_slots,
                 const Texture* shadow_atlas, const Program& light, Buffer& room) {
  const BorrowedBlock block(CHOSEN_LIGHTS_BINDING);
  const ChosenLights chosen = choose_lights(around, shadow_slots);
  room = make_buffer(sizeof chosen, &chosen);
  glBindBufferBase(GL_UNIFORM_BUFFER, CHOSEN_LIGHTS_BINDING, room.id);

  glMemoryBarrier(GL_TEXTURE_FETCH_BARRIER_BIT);
  const GLuint inputs[] = {probe.depth.id, probe.albedo.id, probe.normal.id, probe.emissive.id};
  glBindTextures(0, 4, inputs);
  if (shadow_atlas) glBindTextureUnit(6, shadow_atlas->id);
  glBindImageTexture(0, probe.radiance.id, 0, GL_FALSE, 0, GL_WRITE_ONLY, GL_RGBA16F);
  glBindImageTexture(1, probe.own_light.id, 0, GL_FALSE, 0, GL_WRITE_ONLY, GL_R16F);
  light.use();
  light.set("near_m", capture_near_m);
  light.dispatch(6 * ENVIRONMENT_FACE, ENVIRONMENT_FACE);
  glMemoryBarrier(GL_TEXTURE_FETCH_BARRIER_BIT);
}

void filter_mirrored(EnvironmentProbe& probe, const Program& filter) {
  glBindTextureUnit(0, probe.radiance.id);
  glBindTextureUnit(1, probe.own_light.id);
  glBindImageTexture(0, probe.environment.id, 0, GL_FALSE, 0, GL_WRITE_ONLY, GL_RGBA16F);
  glBindImageTexture(1, probe.own_environment.id, 0, GL_FALSE, 0, GL_WRITE_ONLY, GL_R16F);
  filter.use();
  filter.dispatch(ENVIRONMENT_LEVELS * ENVIRONMENT_TILE, ENVIRONMENT_TILE);
  glMemoryBarrier(GL_TEXTURE_FETCH_BARRIER_BIT);
  probe.lit = true;
}

void filter_faces(EnvironmentProbe& probe, const EnvironmentPrograms& programs) {
  filter_mirrored(probe, programs.filter);
  programs.harmonics.use();
  glDispatchCompute(9, 1, 1);
  glMemoryBarrier(GL_SHADER_IMAGE_ACCESS_BARRIER_BIT);
  glBindImageTexture(0, probe.environment.id, 0, GL_FALSE, 0, GL_READ_WRITE, GL_RGBA16F);
  programs.diffuse.use();
  programs.diffuse.dispatch(ENVIRONMENT_TILE, ENVIRONMENT_TILE);
  glMemoryBarrier(GL_TEXTURE_FETCH_BARRIER_BIT);
}

}  // namespace petrichor
