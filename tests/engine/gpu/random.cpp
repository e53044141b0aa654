// The random numbers of a shader are those of C++, bit for bit: the drop field is asked on both sides.
#include "engine/core/random.hpp"

#include <cstring>
#include <vector>

#include "engine/gpu/shader.hpp"
#include "tests/engine/platform/gl_test.hpp"

namespace petrichor {
namespace {

using RandomOnGpu = test::GlTest;

TEST_F(RandomOnGpu, EqualsTheCpu) {
  constexpr unsigned keys = 4096;
  struct Row {
    glm::uvec4 bits;
    glm::uvec4 float_bits;
    glm::uvec4 poisson;
  };
  test::DataFolder data;
  data.write("random.comp.glsl", R"(
#include "engine/core/random.glsl"
layout(local_size_x = 64) in;
struct Row { uvec4 bits; uvec4 float_bits; uvec4 poisson; };
layout(std430, binding = 0) buffer Out { Row rows[]; };
uniform float u_mean;
uniform float u_zero_probability;
void main() {
  uint i = gl_GlobalInvocationID.x;
  uvec4 key = uvec4(key_of(int(i) - 2048), i * 7u, i / 3u, 99u);
  rows[i].bits = random_bits4(key);
  rows[i].float_bits = floatBitsToUint(random_float4(key));
  rows[i].poisson = uvec4(poisson_count(random_float(key), u_mean, u_zero_probability, 1000u), 0u, 0u, 0u);
}
)");
  ShaderLibrary library;
  auto program = library.load({{"random.comp.glsl"}, {}});
  ASSERT_TRUE(program) << program.error().message;
  const float mean = 3.5f, zero_probability = std::exp(-mean);
  (*program)->use();
  (*program)->set("u_mean", mean);
  (*program)->set("u_zero_probability", zero_probability);
  std::vector<Row> rows(keys);
  Buffer out = make_buffer(keys * sizeof(Row));
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 0, out.id);
  (*program)->dispatch(keys);
  glMemoryBarrier(GL_ALL_BARRIER_BITS);
  read_buffer(out, rows.data(), keys * sizeof(Row));

  unsigned other_counts = 0;
  for (unsigned i = 0; i < keys; ++i) {
    const glm::uvec4 key(key_of(static_cast<int>(i) - 2048), i * 7u, i / 3u, 99u);
    ASSERT_EQ(rows[i].bits, random_bits4(key)) << i;
    const glm::vec4 expected = random_float4(key);
    ASSERT_EQ(std::memcmp(&rows[i].float_bits, &expected, sizeof expected), 0) << i;
    other_counts += rows[i].poisson.x != poisson_count(random_float(key), mean, zero_probability, 1000u);
  }
  // A division's last bit is the driver's own: about one count in a million may fall on the other side.
  EXPECT_LE(other_counts, 1u);
}

}  // namespace
}  // namespace petrichor
