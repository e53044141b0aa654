// Files: .gltf and .glb, buffers inside and beside them, and what is no file at all.
#include <sys/stat.h>

#include "tests/engine/assets/gltf_builder.hpp"

namespace petrichor::testing_gltf {
namespace {

class Container : public Assets {};

void expect_triangle(const Result<Model>& model) {
  ASSERT_TRUE(model) << model.error().message;
  ASSERT_EQ(model->meshes.size(), 1u);
  ASSERT_EQ(model->meshes[0].primitives.size(), 1u);
  EXPECT_EQ(model->meshes[0].primitives[0].indices.size(), 3u);
  glm::vec3 low, high;
  ASSERT_TRUE(model_bounds(*model, low, high));
  EXPECT_EQ(low, glm::vec3(0, 0, 0));
  EXPECT_EQ(high, glm::vec3(1, 1, 0));
}

TEST_F(Container, Embedded) {
  expect_triangle(load(Builder::triangle()));
}

TEST_F(Container, Binary) {
  expect_triangle(load_bytes(Builder::triangle().glb()));
}

TEST_F(Container, BinaryIsToldByItsBytesNotItsName) {
  expect_triangle(load_bytes(Builder::triangle().glb(), "model.gltf"));
}

TEST_F(Container, External) {
  Builder b = Builder::triangle();
  write_file(folder / "data.bin", b.bin);
  b.root["buffers"] = {{{"byteLength", b.bin.size()}, {"uri", "data.bin"}}};
  expect_triangle(load(b));
}

TEST_F(Container, ExternalFileMayBeLonger) {
  Builder b = Builder::triangle();
  Bytes longer = b.bin;
  longer.resize(longer.size() + 100);
  write_file(folder / "data.bin", longer);
  b.root["buffers"] = {{{"byteLength", b.bin.size()}, {"uri", "data.bin"}}};
  expect_triangle(load(b));
}

TEST_F(Container, PercentEncodedAndPlusAndSubfolder) {
  Builder b = Builder::triangle();
  std::filesystem::create_directories(folder / "my data");
  write_file(folder / "my data" / "a+b \xc3\xa4%.bin", b.bin);
  b.root["buffers"] = {{{"byteLength", b.bin.size()}, {"uri", "./my%20data/x/../a+b%20%C3%A4%25.bin"}}};
  expect_triangle(load(b));
}

TEST_F(Container, NameThatHoldsAPercentSign) {
  Builder b = Builder::triangle();
  write_file(folder / "a%20b.bin", b.bin);
  b.root["buffers"] = {{{"byteLength", b.bin.size()}, {"uri", "a%20b.bin"}}};
  expect_triangle(load(b));
}

TEST_F(Container, WindowsSeparators) {
  Builder b = Builder::triangle();
  std::filesystem::create_directories(folder / "parts");
  write_file(folder / "parts" / "data.bin", b.bin);
  b.root["buffers"] = {{{"byteLength", b.bin.size()}, {"uri", "parts\\data.bin"}}};
  expect_triangle(load(b));
  b.root["buffers"][0]["uri"] = "..\\..\\etc\\passwd";
  must_fail(b, {"/buffers/0/uri"});
}

TEST_F(Container, DataUriWithAnyMediaType) {
  Builder b = Builder::triangle();
  b.root["buffers"] = {{{"byteLength", b.bin.size()}, {"uri", "data:;base64," + base64(b.bin)}}};
  expect_triangle(load(b));
  b.root["buffers"][0]["uri"] = "data:application/gltf-buffer;base64," + base64(b.bin);
  expect_triangle(load(b));
}

TEST_F(Container, IntegersWrittenAsReals) {
  Builder b = Builder::triangle();
  b.root["accessors"][0]["count"] = 3.0;
  b.root["nodes"][0]["mesh"] = 0.0;
  expect_triangle(load(b));
}

TEST_F(Container, ByteOrderMark) {
  expect_triangle(load_text("\xef\xbb\xbf" + Builder::triangle().gltf()));
}

TEST_F(Container, UnusedBufferWithoutDataIsFine) {
  Builder b = Builder::triangle();
  b.root["buffers"] = {{{"byteLength", b.bin.size()}, {"uri", "data:;base64," + base64(b.bin)}},
                       {{"byteLength", 4000000000u}}};
  expect_triangle(load(b));
}

TEST_F(Container, UsedBufferWithoutData) {
  Builder b = Builder::triangle();
  b.root["buffers"] = {{{"byteLength", b.bin.size()}}};
  must_fail(b, {"/buffers/0", "neither a uri nor a GLB chunk"});
}

TEST_F(Container, Refused) {
  Builder b = Builder::triangle();
  write_file(folder.parent_path() / "petrichor-outside.bin", b.bin);
  for (const char* uri :
       {"../petrichor-outside.bin", "%2e%2e/petrichor-outside.bin", "x/../../petrichor-outside.bin", "/etc/passwd",
        "file:///etc/passwd", "http://127.0.0.1/x.bin", "C:/x.bin", "", "a%00b", "."}) {
    b.root["buffers"] = {{{"byteLength", 36}, {"uri", uri}}};
    must_fail(b, {"/buffers/0/uri"});
  }
  std::filesystem::remove(folder.parent_path() / "petrichor-outside.bin");
}

TEST_F(Container, MissingShortAndEmptyBuffers) {
  Builder b = Builder::triangle();
  b.root["buffers"] = {{{"byteLength", 36}, {"uri", "gone.bin"}}};
  must_fail(b, {"/buffers/0/uri", "gone.bin"});
  write_file(folder / "short.bin", Bytes(35));
  b.root["buffers"][0]["uri"] = "short.bin";
  must_fail(b, {"/buffers/0/byteLength", "36", "35"});
  write_file(folder / "empty.bin", Bytes{});
  b.root["buffers"][0]["uri"] = "empty.bin";
  must_fail(b, {"/buffers/0/uri", "is empty"});
  b.root["buffers"][0]["uri"] = "data:;base64,AAAA";
  must_fail(b, {"/buffers/0/byteLength", "36", "3"});
  b.root["buffers"][0]["uri"] = "data:;base64,A*AA";
  must_fail(b, {"/buffers/0/uri", "base64"});
  b.root["buffers"][0]["uri"] = "data:nothing";
  must_fail(b, {"/buffers/0/uri", "comma"});
  b.root["buffers"][0]["byteLength"] = 9e15;
  must_fail(b, {"/buffers/0"});
}

TEST_F(Container, NoRegularFile) {
  EXPECT_FALSE(load_model(folder));
  EXPECT_FALSE(load_model(folder / "gone.glb"));
  EXPECT_FALSE(load_model("/dev/zero"));
  EXPECT_FALSE(load_model(""));
  ASSERT_EQ(::mkfifo((folder / "pipe.glb").c_str(), 0600), 0);
  must_fail(load_model(folder / "pipe.glb"), {"no regular file"}, "pipe.glb");  // and does not wait for a writer
  must_fail(load_text(""), {"is empty"});
  Builder b = Builder::triangle();
  ASSERT_EQ(::mkfifo((folder / "data.bin").c_str(), 0600), 0);
  b.root["buffers"] = {{{"byteLength", 36}, {"uri", "data.bin"}}};
  must_fail(b, {"/buffers/0/uri", "no regular file"});
}

TEST_F(Container, HugeFileIsNotRead) {
  write_file(folder / "huge.glb", Bytes(1));
  std::filesystem::resize_file(folder / "huge.glb", 3ull << 30);  // sparse: takes no space
  must_fail(load_model(folder / "huge.glb"), {"at most"}, "huge.glb");
}

TEST_F(Container, TruncatedBinaryNeverLoadsWrong) {
  const Bytes whole = Builder::triangle().glb();
  for (std::size_t size = 1; size < whole.size(); ++size) {
    const auto model = load_bytes(Bytes(whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(size)));
    EXPECT_FALSE(model) << "of " << whole.size() << " bytes, " << size << " were enough";
  }
}

TEST_F(Container, BadChunks) {
  const Bytes whole = Builder::triangle().glb();
  const auto with = [&](std::size_t offset, std::uint32_t value) {
    Bytes copy = whole;
    std::memcpy(copy.data() + offset, &value, 4);
    return load_bytes(copy);
  };
  must_fail(with(4, 1), {"version 1"}, "model.glb");
  must_fail(with(8, 0xffffffffu), {"truncated"}, "model.glb");
  must_fail(with(12, 0xffffffffu), {"chunk 0"}, "model.glb");
  must_fail(with(16, 0x004E4942), {"not JSON"}, "model.glb");
  must_fail(with(8, 0), {"no JSON"}, "model.glb");
}

TEST_F(Container, UnknownChunksAreSkipped) {
  Bytes bytes = Builder::triangle().glb();
  append_u32(bytes, 4);
  append_u32(bytes, 0x12345678);
  append_u32(bytes, 0);
  const auto size = static_cast<std::uint32_t>(bytes.size());
  std::memcpy(bytes.data() + 8, &size, 4);
  expect_triangle(load_bytes(bytes));
}

TEST_F(Container, NoJson) {
  must_fail(load_text("{\"asset\":"), {"no JSON", "line 1"});
  must_fail(load_text("[]"), {"no object"});
  must_fail(load_text("{}"), {"\"asset\" is missing"});
  must_fail(load_text("\xff\xfe\x00\x01"), {"no JSON"});
  must_fail(load_text("{\"asset\":{\"version\":\"2.0\"},\"scene\":NaN}"), {"no JSON"});
  must_fail(load_text("{\"asset\":{\"version\":\"2.0\"},\"nodes\":[{\"scale\":[1e999,1,1]}]}"), {"no JSON"});
  must_fail(load_text("{\"asset\":{\"version\":\"1.0\"}}"), {"/asset/version", "1.0", "2.0"});
  must_fail(load_text("{\"asset\":{\"version\":\"2.0\",\"minVersion\":\"2.1\"}}"), {"/asset/minVersion"});
  must_fail(load_text(std::string(200, '\0')), {"no JSON"});
}

TEST_F(Container, DeepJson) {
  const std::string asset = "{\"asset\":{\"version\":\"2.0\"},\"extras\":";
  must_fail(load_text(asset + std::string(1000000, '[')), {"nested deeper"});
  std::string objects;
  for (int i = 0; i < 100000; ++i) objects += "{\"a\":";
  must_fail(load_text(asset + objects), {"nested deeper"});
  // Brackets inside strings do not count, and extras may nest a good deal.
  EXPECT_TRUE(load_text(asset + "\"" + std::string(1000, '[') + "\\\"{\"}"));
  EXPECT_TRUE(load_text(asset + std::string(400, '[') + std::string(400, ']') + "}"));
}

TEST_F(Container, CountlessValues) {
  std::string text = "{\"asset\":{\"version\":\"2.0\"},\"nodes\":[{}";
  for (int i = 0; i < 9'000'000; ++i) text += ",1";
  must_fail(load_text(text + "]}"), {"values"});
}

TEST_F(Container, EmptyModel) {
  const auto model = load_text("{\"asset\":{\"version\":\"2.0\"}}");
  ASSERT_TRUE(model) << model.error().message;
  EXPECT_TRUE(model->nodes.empty());
  EXPECT_TRUE(warned(*model, "no nodes"));
  glm::vec3 low, high;
  EXPECT_FALSE(model_bounds(*model, low, high));
}

TEST_F(Container, Extensions) {
  Builder b = Builder::triangle();
  b.root["extensionsUsed"] = {"FOO_optional", "KHR_lights_punctual", "FOO_optional"};
  const Model model = must_load(b);
  EXPECT_EQ(model.warnings.size(), 1u);
  EXPECT_TRUE(warned(model, "FOO_optional"));
  b.root["extensionsRequired"] = {"KHR_texture_transform", "BAR_needed"};
  must_fail(b, {"/extensionsRequired/1", "BAR_needed"});
  b.root["extensionsRequired"] = {"KHR_lights_punctual", "KHR_materials_emissive_strength", "KHR_texture_transform",
                                  "KHR_mesh_quantization", "KHR_materials_unlit"};
  must_load(b);
}

}  // namespace
}  // namespace petrichor::testing_gltf
