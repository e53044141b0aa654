#pragma once
// Solids and sweeps into a Mesh, in a local frame. A facade's frame has x to the right along the wall as seen
// from the street, y up and z out of the wall, so one set of helpers serves walls, kerbs and cars alike.

#include <functional>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "content/city/scene.hpp"

namespace petrichor::city {

struct Paint {
  Mat mat = Mat::plain;
  glm::vec3 colour{1.0f};
  glm::vec2 uv{0.0f};  // palette cell of plain and glow; offset in metres of a tiling material
};

Paint plain(glm::vec3 colour, Finish finish);
Paint glow(Glow);
Paint tiling(Mat mat, glm::vec3 tint = glm::vec3(1.0f), glm::vec2 offset_m = glm::vec2(0.0f));

// A rectangle of an atlas, v downwards as in glTF.
struct UvRect {
  glm::vec2 minimum{0.0f};
  glm::vec2 maximum{1.0f};
};

// Faces of a box, to leave out what nobody can see.
enum Faces : unsigned {
  face_left = 1,
  face_right = 2,
  face_bottom = 4,
  face_top = 8,
  face_back = 16,
  face_front = 32,
  face_sides = face_left | face_right,
  face_all = 63,
  face_no_back = 63 & ~face_back,
  face_no_bottom = 63 & ~face_bottom,
};

class Builder {
 public:
  explicit Builder(Mesh& mesh, const glm::mat4& frame = glm::mat4(1.0f));

  Builder at(const glm::mat4& local) const { return Builder(*mesh_, frame_ * local); }
  Builder moved(glm::vec3 offset_m, float turn_y_rad = 0.0f) const;
  const glm::mat4& frame() const { return frame_; }

  // Corners counter-clockwise seen from the front. Texture coordinates follow the local plane in metres.
  void quad(const Paint&, glm::vec3 a, glm::vec3 b, glm::vec3 c, glm::vec3 d);
  void triangle(const Paint&, glm::vec3 a, glm::vec3 b, glm::vec3 c);
  void fan(const Paint&, std::span<const glm::vec3> convex);
  // a is the picture's lower left, b its lower right.
  void picture(Mat, glm::vec3 tint, UvRect, glm::vec3 a, glm::vec3 b, glm::vec3 c, glm::vec3 d);
  void box(const Paint&, glm::vec3 minimum, glm::vec3 maximum, unsigned faces = face_all);
  // Profile points are (z out, y up), from bottom to top as seen from the left end; swept along x. A miter is
  // dx per metre of z at that end, so that cornices meet round a corner.
  void moulding(const Paint&, std::span<const glm::vec2> profile, float x0, float x1, float miter0 = 0.0f,
                float miter1 = 0.0f, bool caps = true);
  void cylinder(const Paint&, glm::vec3 a, glm::vec3 b, float radius_a, float radius_b, int sides, bool cap_a = false,
                bool cap_b = false);
  void tube(const Paint&, std::span<const glm::vec3> path, float radius_m, int sides, bool closed = false);
  // Profile points are (radius, y) from the top down; turned round the local y axis.
  void lathe(const Paint&, std::span<const glm::vec2> profile, int sides);
  // A smooth surface over [0,1]^2 with du x dv pointing out.
  using Surface = std::function<glm::vec3(float u, float v)>;
  void surface(const Paint&, int nu, int nv, const Surface& position);
  void vertex_triangle(Mat, const Vertex& a, const Vertex& b, const Vertex& c);  // local frame

 private:
  std::uint32_t put(Primitive&, const Paint&, glm::vec3 position, glm::vec3 normal, glm::vec2 plane_uv);
  Primitive& primitive(Mat mat) { return mesh_->primitives[mat]; }

  Mesh* mesh_;
  glm::mat4 frame_;
  glm::mat3 turn_;
};

// Frame of a wall that looks along `out` (horizontal), with its left end at origin.
glm::mat4 wall_frame(glm::vec3 origin, glm::vec3 out);

}  // namespace petrichor::city
