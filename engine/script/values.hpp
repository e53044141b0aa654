#pragma once
// Inside engine/script: values between Lua and JSON, and vectors as scripts see them.

#include <nlohmann/json_fwd.hpp>
#include <span>
#include <string>

#include "engine/core/result.hpp"
#include "engine/ecs/schema.hpp"

struct lua_State;

namespace petrichor::script {

// Registers the metatable of vectors: v.x .y .z .w (.r .g .b), arithmetic, comparison, text.
void open_vectors(lua_State*);
// Pushes 2 to 4 numbers as a vector: a table {x, y, z} with names and arithmetic.
void push_vector(lua_State*, std::span<const double>);
// Reads {1, 2, 3}, {x=, y=, z=} or {r=, g=, b=}; raises a Lua error naming `what` where it is anything else.
void check_vector(lua_State*, int index, std::span<double> out, const std::string& what);

// A field's value for write_field; raises where Lua's value cannot be one at all (the schema checks the rest).
nlohmann::json check_field_value(lua_State*, int index, const Schema&, const Field&);
void push_json(lua_State*, const nlohmann::json&);

// Any table of plain data as JSON (see read_table); the error names the place, "passes[2].reads".
Result<nlohmann::json> to_json(lua_State*, int index);

// Texts go to JSON files and to the screen: UTF-8 only.
bool is_utf8(std::string_view);

// What a value is, for messages: `the string "abc"`, `a table`.
std::string describe(lua_State*, int index);

int make_vector(lua_State*);  // vec3(x, y, z)

}  // namespace petrichor::script
