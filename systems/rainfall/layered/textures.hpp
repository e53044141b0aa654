#pragma once
// What the layered composite is made of, made procedurally at the first use.

#include <array>
#include <cstdint>
#include <vector>

namespace petrichor {

// The placement texture, 256 x 256 texels of four 8-bit values: a mark (a drop is there where more than mark / 256 of
// all are shown), its place across and along its cell, and its distance within its shell. Every column holds each
// value once in each channel, in an order of its own, so that the share of drops that is shown is exact in each.
std::vector<std::array<std::uint8_t, 4>> make_placement();

// As the shaders read it: each texel with the one above it, both packed into 32 bits. Where cells are 2^stretch times
// as tall, every 2^stretch-th of them remains, where it was.
std::vector<std::array<std::uint32_t, 2>> pair_placement(const std::vector<std::array<std::uint8_t, 4>>&, int stretch);

// The normal map of drops of 1 to 6 mm seen from the side, wobbling and canted: rgba8, size x size texels a drop, row 0
// below; x and y of the normal times coverage, and coverage in z, as signed bytes. Source: axis_ratio().
std::vector<std::array<std::int8_t, 4>> make_drop_normals(int size, int drops);

}  // namespace petrichor
