#include "systems/lighting/shadow_maps.hpp"

#include <algorithm>
#include <cmath>

#include "systems/frame_gpu.hpp"
#include "systems/gpu_scene.hpp"
#include "systems/lighting/chosen_lights.hpp"
#include "systems/lighting/cube_faces.hpp"

namespace petrichor {
namespace {

constexpr float quarter_turn = 1.57079632679f;
constexpr float face_corner_rad = 0.9553166181f;  // from a face's axis to its corner

void make_targets(ShadowMaps& maps) {
  maps.face_depth = make_texture_2d_array(SHADOW_FACE, SHADOW_FACE, 6, GL_DEPTH_COMPONENT32F);
  maps.tile = make_texture_2d(SHADOW_TILE, SHADOW_TILE, GL_RG32F, SHADOW_BLUR_LEVEL + 1);
  for (int face = 0; face < 6; ++face) {
    GLuint id = 0;
    glCreateFramebuffers(1, &id);
    glNamedFramebufferTextureLayer(id, GL_DEPTH_ATTACHMENT, maps.face_depth.id, 0, face);
    glNamedFramebufferDrawBuffer(id, GL_NONE);
    maps.faces[static_cast<std::size_t>(face)] = Framebuffer(id);
  }
}

// Whether any of a spot's light falls on this face of the cube round it.
bool lights_face(const FrameLight& light, int face) {
  if (light.kind != LIGHT_SPOT) return true;
  const float angle =
      std::acos(std::clamp(glm::dot(glm::normalize(light.direction), cube_face(face).forward), -1.0f, 1.0f));
  return angle < light.outer_cone_rad + face_corner_rad;
}

void draw_map(ShadowMaps& maps, const FrameLight& light, Frame& around_light, int slot, const Texture& atlas,
              const ShadowPrograms& programs) {
  around_light.camera.position_m = glm::dvec3(light.position_m);
  upload_instances(*around_light.scene, around_light);

  glEnable(GL_DEPTH_TEST);
  glDepthFunc(GL_GREATER);
  glDepthMask(GL_TRUE);
  glDisable(GL_CULL_FACE);
  glDisable(GL_BLEND);
  glViewport(0, 0, SHADOW_FACE, SHADOW_FACE);
  programs.depth.use();
  for (int face = 0; face < 6; ++face) {
    const float zero = 0.0f;
    glClearNamedFramebufferfv(maps.faces[static_cast<std::size_t>(face)], GL_DEPTH, 0, &zero);
    if (!lights_face(light, face)) continue;
    glBindFramebuffer(GL_FRAMEBUFFER, maps.faces[static_cast<std::size_t>(face)]);
    const glm::mat4 clip = view_projection_of(cube_face_orientation(face), quarter_turn, 1.0f, SHADOW_NEAR_M);
    programs.depth.set("clip_from_relative", clip);
    draw_instances(*around_light.scene, around_light, clip, DrawWhat::depth_only);
  }
  glDisable(GL_DEPTH_TEST);
  glBindFramebuffer(GL_FRAMEBUFFER, 0);

  programs.moments.use();
  programs.moments.set("reach_m", shadow_reach_m(light));
  glBindTextureUnit(0, maps.face_depth.id);
  glBindImageTexture(0, maps.tile.id, 0, GL_FALSE, 0, GL_WRITE_ONLY, GL_RG32F);
  programs.moments.dispatch(SHADOW_TILE, SHADOW_TILE);
  glMemoryBarrier(GL_TEXTURE_FETCH_BARRIER_BIT | GL_FRAMEBUFFER_BARRIER_BIT | GL_TEXTURE_UPDATE_BARRIER_BIT);
  glGenerateTextureMipmap(maps.tile.id);

  programs.pack.use();
  programs.pack.set("tile_origin",
                    glm::ivec2(slot % SHADOW_TILES_PER_SIDE, slot / SHADOW_TILES_PER_SIDE) * SHADOW_TILE);
  glBindTextureUnit(0, maps.tile.id);
  glBindImageTexture(0, atlas.id, 0, GL_FALSE, 0, GL_WRITE_ONLY, GL_RGBA32F);
  programs.pack.dispatch(SHADOW_TILE, SHADOW_TILE);
  ++maps.maps_drawn;
}

}  // namespace

bool ShadowMaps::Tile::same_light(const Tile& other) const {
  return filled && other.filled && position_m == other.position_m && direction == other.direction &&
         kind == other.kind && outer_cone_rad == other.outer_cone_rad && reach_m == other.reach_m;
}

void update_shadow_maps(ShadowMaps& maps, const Frame& frame, const Texture& atlas, bool fresh,
                        const ShadowPrograms& programs) {
  if (!maps.face_depth.id) make_targets(maps);
  if (fresh || maps.geometry_version != frame.geometry_version || maps.scene != frame.scene) {
    for (ShadowMaps::Tile& tile : maps.tiles) tile.filled = false;
    maps.geometry_version = frame.geometry_version;
    maps.scene = frame.scene;
  }
  maps.slots.assign(frame.lights.size(), -1);
  if (!frame.scene) return;

  // The tile follows from the frame alone: where a map lies in the atlas touches the last bit of what is read from it.
  const std::vector<std::size_t> casters = shadow_casters(frame);
  Frame around_light;
  for (std::size_t slot = 0; slot < casters.size(); ++slot) {
    const FrameLight& light = frame.lights[casters[slot]];
    maps.slots[casters[slot]] = static_cast<int>(slot);
    const ShadowMaps::Tile wanted{
        true, light.position_m, light.direction, light.outer_cone_rad, shadow_reach_m(light), light.kind};
    if (maps.tiles[slot].same_light(wanted)) continue;
    if (!around_light.scene) {
      around_light.scene = frame.scene;
      around_light.instances = frame.instances;
    }
    draw_map(maps, light, around_light, static_cast<int>(slot), atlas, programs);
    maps.tiles[slot] = wanted;
  }
  if (!around_light.scene) return;
  glMemoryBarrier(GL_TEXTURE_FETCH_BARRIER_BIT);
  upload_instances(*frame.scene, frame);  // the other passes' instances are relative to the camera
}

}  // namespace petrichor
