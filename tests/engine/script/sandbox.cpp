// What a script cannot do: run for ever, take all memory, crash, or reach outside.

#include <unistd.h>

#include "tests/engine/script/fixture.hpp"

namespace petrichor {
namespace {

class Sandbox : public ScriptTest {
 protected:
  Sandbox() {
    options.limits.load_instructions = 3'000'000;
    options.limits.step_instructions = 1'000'000;
    options.limits.memory_bytes = 32 << 20;
    options.limits.wall_s = 60.0;  // so that it is the count that stops them
  }
};

// Each of these tries to go on for ever, or to swallow the end.
class EndlessScript : public Sandbox, public testing::WithParamInterface<std::pair<const char*, const char*>> {};

TEST_P(EndlessScript, IsStopped) {
  options.limits.memory_bytes = 512 << 20;
  const std::string message = error_of(GetParam().second);
  EXPECT_CONTAINS(message, "test.lua:");
  EXPECT_CONTAINS(message, "million instructions");
  EXPECT_CONTAINS(message, "stack traceback:");
  // Nothing of it goes on, and the host serves other scripts.
  expect_ok("print('alive')");
  EXPECT_EQ(printed.back(), "alive");
}

INSTANTIATE_TEST_SUITE_P(
    All, EndlessScript,
    testing::Values(
        std::pair{"loop", "while true do end"},
        std::pair{"pcall_inside", "while true do pcall(function() while true do end end) end"},
        std::pair{"pcall_around", "pcall(function() while true do end end) while true do end"},
        std::pair{"pcall_nested", "local function f() pcall(f) f() end f() while true do f() end"},
        std::pair{"xpcall_handler",
                  "xpcall(function() while true do end end, function() while true do end end) while true do end"},
        std::pair{"xpcall_error_in_handler", "xpcall(error, function() while true do end end)"},
        std::pair{"wrap", "local f = coroutine.wrap(function() while true do end end) pcall(f) while true do end"},
        std::pair{"resume", "while true do coroutine.resume(coroutine.create(function() while true do end end)) end"},
        std::pair{"coroutines",
                  "local function f() return coroutine.wrap(function() for i = 1, 20 do f() end end)() end while true "
                  "do pcall(f) end"},
        std::pair{"short_coroutines", "local function g() end while true do coroutine.wrap(g)() end"},
        std::pair{"index", "setmetatable(_G, {__index = function() while true do end end}) return nowhere"},
        std::pair{"concat", "return setmetatable({}, {__concat = function() while true do end end}) .. 'x'"},
        std::pair{"close", "do local x <close> = setmetatable({}, {__close = function() while true do end end}) end"},
        std::pair{"close_after_kill",
                  "local H = {} H.__close = function() local a <close> = setmetatable({}, H) local b <close> = "
                  "setmetatable({}, H) "
                  "while true do end end do local x <close> = setmetatable({}, H) while true do end end"},
        std::pair{"close_in_wrap",
                  "coroutine.wrap(function() local x <close> = setmetatable({}, {__close = function() while true do "
                  "end end}) "
                  "while true do end end)()"},
        std::pair{"close_in_wrap_after_error",
                  "coroutine.wrap(function() local x <close> = setmetatable({}, {__close = function() while true do "
                  "end end}) "
                  "error('x') end)()"},
        std::pair{"close_by_hand",
                  "local co = coroutine.create(function() local x <close> = setmetatable({}, {__close = function() "
                  "while true do end end}) "
                  "coroutine.yield() end) coroutine.resume(co) coroutine.close(co)"},
        std::pair{"tostring", "print(setmetatable({}, {__tostring = function() while true do end end}))"},
        std::pair{"error_tostring",
                  "pcall(error, setmetatable({}, {__tostring = function() while true do end end})) while true do end"},
        std::pair{"sort", "table.sort({3, 2, 1}, function() while true do end end)"},
        std::pair{"gsub", "(('x'):rep(9)):gsub('x', function() while true do end end)"},
        std::pair{"move", "table.move({}, 1, 1 << 60, 2)"},
        std::pair{"move_negative", "table.move({}, math.mininteger, -2, 2)"},
        std::pair{"unpack", "while true do table.unpack({}, 1, 100000) end"},
        std::pair{"concat_range", "table.concat(setmetatable({}, {__index = type}), '', 1, 1 << 60)"},
        std::pair{"upper", "local s = ('x'):rep(1 << 20) while true do s:upper() end"},
        std::pair{"next", "local t = {} for i = 1, 1000 do t[i] = i end while true do next(t) end"},
        std::pair{"emit_chain", "while true do emit('x') end"},
        std::pair{"find", "local s = ('x'):rep(200) while true do s:find('y+') end"}),
    [](const auto& info) { return info.param.first; });

TEST_F(Sandbox, KilledCoroutineStaysDeadInLaterSteps) {
  // Its pending __close would run with the hooks off.
  error_of(
      "co = coroutine.create(function() local x <close> = setmetatable({}, {__close = function() while true do end "
      "end}) "
      "while true do end end) coroutine.resume(co)");
  expect_ok("print(coroutine.close(co))");
  EXPECT_EQ(printed.back(), "false\tkilled");
  expect_ok("print(coroutine.resume(co))");
  EXPECT_EQ(printed.back().substr(0, 5), "false");
}

TEST_F(Sandbox, RepeatingNothingEndsAtOnce) {
  expect_ok("print(#(''):rep(1 << 62), #(''):rep(1 << 62, ''), ('ab'):rep(3, '-'))");
  EXPECT_EQ(printed.back(), "0\t0\tab-ab-ab");
}

TEST_F(Sandbox, LengthsThatLieAreRefused) {
  for (const char* call :
       {"table.insert(t, 1, 0)", "table.remove(t, 1)", "table.sort(t)", "table.concat(t)", "table.unpack(t)"}) {
    EXPECT_CONTAINS(
        error_of("local t = setmetatable({}, {__len = function() return 1 << 60 end}) " + std::string(call)), "__len");
  }
}

TEST_F(Sandbox, FinalisersAreRefused) {
  EXPECT_CONTAINS(error_of("setmetatable({}, {__gc = function() while true do end end})"), "__gc");
  // Added afterwards, Lua never calls it: the mark is set by setmetatable.
  expect_ok(
      "local m = {} setmetatable({}, m) m.__gc = function() while true do end end for i = 1, 20000 do local t = {i} "
      "end");
}

TEST_F(Sandbox, CostlyPatternsAreRefused) {
  const std::string message = error_of("return (('a'):rep(200)):find(('a*'):rep(30) .. 'b')");
  EXPECT_CONTAINS(message, "test.lua:1:");
  EXPECT_CONTAINS(message, "pattern");
  error_of("for x in (('a'):rep(5000)):gmatch('(a*)(a*)(a*)b') do end");
  error_of("(('a'):rep(5000)):gsub('.-.-.-b', '')");
  error_of("(('('):rep(100000)):find('%b()')");
  expect_ok("print((('  dry kerb '):match('^%s*(.-)%s*$')), ('a,b;c'):gsub('[,;]', ' '))");
  EXPECT_EQ(printed.back(), "dry kerb\ta b c\t2");
}

// Memory.
class HungryScript : public Sandbox, public testing::WithParamInterface<std::pair<const char*, const char*>> {};

TEST_P(HungryScript, IsStopped) {
  options.limits.load_instructions = 200'000'000;
  const std::string message = error_of(GetParam().second);
  EXPECT_CONTAINS(message, "test.lua:");
  EXPECT_CONTAINS(message, "32 MiB of memory");
  EXPECT_CONTAINS(message, "stack traceback:");
  expect_ok("print('alive')");
}

INSTANTIATE_TEST_SUITE_P(
    All, HungryScript,
    testing::Values(std::pair{"doubling", "local s = 'x' while true do s = s .. s end"},
                    std::pair{"table", "local t = {} while true do t[#t + 1] = {1, 2, 3} end"},
                    std::pair{"keys", "local t = {} for i = 1, 1e9 do t['k' .. i] = i end"},
                    std::pair{"rep", "return ('x'):rep(1e10)"},
                    std::pair{"rep_loop", "local t = {} while true do t[#t + 1] = ('x'):rep(1e6 + #t) end"},
                    std::pair{"concat",
                              "local t = {} for i = 1, 1e5 do t[i] = 'xxxxxxxxxx' end local s = table.concat(t) "
                              "while true do s = table.concat({s, s}) end"},
                    std::pair{"pcall",
                              "while true do pcall(string.rep, 'x', 31 << 20) pcall(function() local s = 'x' "
                              "while true do s = s .. s end end) end"},
                    std::pair{"coroutines",
                              "local t = {} while true do t[#t + 1] = coroutine.create(function() end) end"}),
    [](const auto& info) { return info.param.first; });

TEST_F(Sandbox, MemoryIsFreeAgainAfterwards) {
  options.limits.load_instructions = 200'000'000;
  for (int i = 0; i < 5; ++i) error_of("local s = 'x' while true do s = s .. s end");
  expect_ok("local s = ('x'):rep(10 << 20) print(#s)");
}

TEST_F(Sandbox, ACapBelowLuaItselfIsAnError) {
  options.limits.memory_bytes = 1000;
  EXPECT_FALSE(run("return 1"));
  options.limits.memory_bytes = 12000;
  made.reset();
  EXPECT_FALSE(run("return 1"));
}

// Depth.
TEST_F(Sandbox, DeepRecursionIsAnError) {
  options.limits.load_instructions = 200'000'000;
  options.limits.memory_bytes = 256 << 20;
  EXPECT_CONTAINS(error_of("local function f() return 1 + f() end f()"), "stack overflow");
  EXPECT_CONTAINS(error_of("local function f(x) return (x:gsub('.', f)) end f('abc')"), "overflow");
  EXPECT_CONTAINS(
      error_of("local t = setmetatable({}, {}) getmetatable(t).__index = function(_, k) return t[k] end return t.x"),
      "overflow");
  EXPECT_CONTAINS(error_of("local function f() return coroutine.wrap(f)() end f()"), "overflow");
  EXPECT_CONTAINS(error_of("return " + std::string(100000, '(') + "1" + std::string(100000, ')')), "overflow");
  EXPECT_CONTAINS(error_of("local function f() local ok, e = pcall(f) error(e, 0) end f()"), "overflow");
  EXPECT_CONTAINS(error_of("local function f() local ok, e = pcall(f) if not ok then error(e, 0) end end f()"),
                  "overflow");
}

TEST_F(Sandbox, ClosingInsideClosingIsBounded) {
  error_of(
      "local function f() coroutine.wrap(function() local x <close> = setmetatable({}, {__close = function() f() end}) "
      "error('x') end)() end f()");
  error_of(
      "local function f() local co = coroutine.create(function() local x <close> = setmetatable({}, {__close = "
      "function() f() end}) coroutine.yield() end) "
      "coroutine.resume(co) assert(coroutine.close(co)) end f()");
}

// Nothing from outside.
TEST_F(Sandbox, OutsideIsOutOfReach) {
  for (const char* name : {"os", "io", "debug", "package", "load", "loadfile", "dofile", "loadstring", "string.dump",
                           "math.randomseed", "warn"}) {
    expect_ok(std::string("print(") + name + ")");
    EXPECT_EQ(printed.back(), "nil") << name;
  }
  EXPECT_CONTAINS(error_of("collectgarbage('stop')"), "collectgarbage");
  EXPECT_CONTAINS(error_of("getmetatable('').__index = nil"), "test.lua:1:");
  expect_ok("print(getmetatable(''), pcall(setmetatable, '', {}))");
  EXPECT_EQ(printed.back().substr(0, 12), "string\tfalse");
  expect_ok(
      "string.format = nil local e = world.spawn{emitter={}} print(getmetatable(e), getmetatable(e.emitter), "
      "getmetatable(vec3(1, 2, 3)))");
  EXPECT_EQ(printed.back(), "entity\tcomponent\tvector");
  error_of("rawset(world.spawn{emitter={}}, 'x', 1)");
  error_of("local f = pairs({1}) f(nil)");
  error_of("local f = pairs({1}) f('x')");
  error_of("world.spawn{emitter={}}.emitter.__index = 1");
}

TEST_F(Sandbox, RequireReachesTheRootsOnly) {
  write("parts/lamp.lua", "print('lamp', ...) return {height_m = 6}");
  expect_ok("local a, b = require('parts.lamp'), require('parts/lamp') print(a == b, a.height_m)");
  EXPECT_EQ(printed, (std::vector<std::string>{"lamp\tparts.lamp", "true\t6"}));
  const auto outside = folder.parent_path() / (folder.filename().string() + "_outside.lua");
  std::ofstream(outside) << "return 'outside'";
  std::filesystem::create_symlink(outside, folder / "link.lua");
  for (const std::string& name :
       {"../" + outside.stem().string(), "parts/../../" + outside.stem().string(), outside.string(),
        std::string("/etc/passwd"), std::string(""), std::string("a\\0b"), std::string("..x"), std::string("link"),
        std::string("nowhere"), std::string("parts")}) {
    const std::string message = error_of("return require('" + name + "')");
    EXPECT_CONTAINS(message, "require");
    EXPECT_CONTAINS(message, "test.lua:1:");
  }
  std::filesystem::remove(outside);
  write("a.lua", "return require('b')");
  write("b.lua", "return require('a')");
  EXPECT_CONTAINS(error_of("require('a')"), "required by itself");
  write("bad.lua", "local x = 1\nerror('wet')");
  EXPECT_CONTAINS(error_of("require('bad')"), "bad.lua:2: wet");
  write("loop.lua", "while true do end");
  EXPECT_CONTAINS(error_of("while true do pcall(require, 'loop') end"), "million instructions");
}

TEST_F(Sandbox, BytecodeIsRefused) {
  const std::string bytecode("\x1bLua\x54\x00\x19\x93\r\n\x1a\n", 12);
  EXPECT_CONTAINS(error_of(bytecode), "compiled Lua");
  EXPECT_CONTAINS(error_of("#!/usr/bin/lua\n" + bytecode), "test.lua");
  write("byte.lua", bytecode);
  EXPECT_CONTAINS(error_of("require('byte')"), "compiled Lua");
  EXPECT_FALSE(read_table(folder / "byte.lua", options));
}

TEST_F(Sandbox, OddFilesAreErrors) {
  EXPECT_CONTAINS(host().run_file(folder / "nowhere.lua").error().message, "no such script");
  EXPECT_CONTAINS(host().run_file(folder).error().message, "folder");
  EXPECT_FALSE(host().run_file("/dev/zero"));
  write("huge.lua", std::string(9 << 20, ' '));
  EXPECT_CONTAINS(host().run_file(folder / "huge.lua").error().message, "8 MiB");
  expect_ok("");
  expect_ok("\xef\xbb\xbfprint('bom')");
  expect_ok("#!/usr/bin/env petrichor\nprint('shebang')");
}

// Errors.
TEST_F(Sandbox, ErrorsCarryFileLineAndTraceback) {
  const std::string message = error_of("local function wet()\n  local t = nil\n  return t.x\nend\nwet()\n");
  EXPECT_CONTAINS(message, "test.lua:3: attempt to index a nil value (local 't')");
  EXPECT_CONTAINS(message, "stack traceback:");
  EXPECT_CONTAINS(message, "test.lua:5: in main chunk");
  EXPECT_CONTAINS(error_of("x = = 1"), "test.lua:1:");
  EXPECT_CONTAINS(error_of("\n\nerror({})"), "test.lua:3:");
  EXPECT_CONTAINS(error_of("\nerror()"), "test.lua:2:");
  EXPECT_CONTAINS(error_of("error(setmetatable({}, {__tostring = function() return 'said' end}))"), "said");
  EXPECT_CONTAINS(error_of("error(setmetatable({}, {__tostring = function() error('twice') end}))"), "twice");
  EXPECT_CONTAINS(error_of("assert(false, 'dry')"), "dry");
}

// The same in every run.
TEST_F(Sandbox, PairsHasAnOrder) {
  expect_ok(
      "local t = {b=1, a=2, [3]=3, [1.5]=4, [true]=5, c=6, [1]=7} local s = {} for k, v in pairs(t) do s[#s + 1] = "
      "tostring(k) .. '=' .. v end print(table.concat(s, ' '))");
  EXPECT_EQ(printed.back(), "1=7 1.5=4 3=3 a=2 b=1 c=6 true=5");
  expect_ok(
      "local t, s, k, v = {x=1, y=2, a=3}, '' repeat k, v = next(t, k) if k then s = s .. k .. v end until not k "
      "print(s, next({}))");
  EXPECT_EQ(printed.back(), "a3x1y2\tnil");
  expect_ok("local t = {a=1, b=2, c=3} for k in pairs(t) do t.b = nil t[k] = nil end print(next(t))");
  EXPECT_EQ(printed.back(), "nil");
  EXPECT_CONTAINS(error_of("for k in pairs({[{}]=1}) do end"), "order");
  expect_ok(
      "local a, b = world.spawn{name='a'}, world.spawn{name='b'} local t = {[b]=2, [a]=1} for e, n in pairs(t) do "
      "print(e.name, n) end print(t[world.find('b')])");
  EXPECT_EQ(printed.back(), "2");
}

TEST_F(Sandbox, RandomNumbersComeFromTheSeed) {
  const std::string text = "print(math.random(), math.random(6), math.random(-3, 3), math.random(0))";
  expect_ok(text);
  made.reset();
  expect_ok(text);
  EXPECT_EQ(printed[0], printed[1]);
  made.reset();
  options.seed = 2;
  expect_ok(text);
  EXPECT_NE(printed[0], printed[2]);
  expect_ok(
      "for i = 1, 10000 do local a, b = math.random(), math.random(3) assert(a >= 0 and a < 1 and b >= 1 and b <= 3) "
      "end "
      "assert(math.type(math.random(math.mininteger, math.maxinteger)) == 'integer')");
  // The mean of 10000 uniform numbers: 0.5 with a standard deviation of 0.0029.
  expect_ok("local s = 0 for i = 1, 10000 do s = s + math.random() end assert(math.abs(s / 10000 - 0.5) < 0.015)");
  error_of("math.random(2, 1)");
}

TEST_F(Sandbox, TheClockIsABackstop) {
  options.limits.load_instructions = ~0ull >> 1;
  options.limits.wall_s = 0.2;
  EXPECT_CONTAINS(error_of("while true do end"), "0.2 s");
}

}  // namespace
}  // namespace petrichor
