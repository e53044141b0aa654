#include "engine/gpu/shader_source.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <iterator>
#include <regex>
#include <sstream>

#include "engine/core/paths.hpp"

namespace petrichor {
namespace {

constexpr std::size_t kMaxSourceBytes = 4u << 20;

std::string_view trimmed(std::string_view text) {
  const std::size_t first = text.find_first_not_of(" \t\r");
  if (first == text.npos) return {};
  return text.substr(first, text.find_last_not_of(" \t\r") - first + 1);
}

// "#  include "x"" -> directive "include", rest "\"x\"". False where the line is no directive.
bool split_directive(std::string_view line, std::string_view& directive, std::string_view& rest) {
  line = trimmed(line);
  if (line.empty() || line.front() != '#') return false;
  line = trimmed(line.substr(1));
  const std::size_t end = std::min(line.find_first_of(" \t\"<("), line.size());
  directive = line.substr(0, end);
  rest = trimmed(line.substr(end));
  return true;
}

// Blanks comments out of one line; `in_block` carries over to the next.
std::string without_comments(std::string_view line, bool& in_block) {
  std::string out;
  for (std::size_t i = 0; i < line.size(); ++i) {
    if (in_block) {
      if (line.substr(i, 2) == "*/") {
        in_block = false;
        ++i;
        out += ' ';
      }
    } else if (line.substr(i, 2) == "/*") {
      in_block = true;
      ++i;
    } else if (line.substr(i, 2) == "//") {
      break;
    } else {
      out += line[i];
    }
  }
  return out;
}

class Reader {
 public:
  explicit Reader(std::vector<SourceFile>& files) : files_(files) {}

  Result<void> add(const SourceFile& file, int depth_of_conditions) {
    std::ifstream stream(file.path, std::ios::binary);
    if (!stream) return failure(fmt::format("{}: cannot be read", file.name));
    std::string text((std::istreambuf_iterator<char>(stream)), {});
    if (text.starts_with("\xEF\xBB\xBF")) text.erase(0, 3);

    const std::size_t index = index_of(file);
    stack_.push_back(index);
    if (depth_of_conditions == 0) taken_always_.push_back(index);
    const bool main_file = stack_.size() == 1;
    if (!main_file) line_marker(1, index);

    bool in_block = false;
    std::vector<Condition> conditions;
    std::istringstream lines(text);
    std::string raw;
    for (int number = 1; std::getline(lines, raw); ++number) {
      if (!raw.empty() && raw.back() == '\r') raw.pop_back();
      const std::string line = without_comments(raw, in_block);
      std::string_view directive, rest;
      const bool is_directive = split_directive(line, directive, rest);
      if (is_directive && follow_cplusplus(directive, rest, conditions)) {
        output += '\n';
        continue;
      }
      if (for_cplusplus(conditions)) {
        output += '\n';
        continue;
      }
      if (is_directive && directive == "include") {
        const std::size_t open =
            std::count_if(conditions.begin(), conditions.end(), [](Condition c) { return c == Condition::ordinary; });
        if (auto done = include(rest, file, number, depth_of_conditions + static_cast<int>(open)); !done) return done;
        line_marker(number + 1, index);
      } else if (is_directive && directive == "version") {
        if (!main_file) {
          return failure(fmt::format("{}:{}: #version belongs into the main shader, not into an included file",
                                     file.name, number));
        }
        version = std::string(trimmed(line));
        output += '\n';
      } else if (is_directive && directive == "pragma" && rest == "once") {
        output += '\n';
      } else {
        output += raw;
        output += '\n';
      }
      if (output.size() > kMaxSourceBytes) {
        return failure(
            fmt::format("{}:{}: more than {} MiB of text after includes", file.name, number, kMaxSourceBytes >> 20));
      }
    }
    stack_.pop_back();
    return {};
  }

  std::string output;
  std::string version;

 private:
  enum class Condition { ordinary, cplusplus, not_cplusplus };

  static bool for_cplusplus(const std::vector<Condition>& conditions) {
    return std::find(conditions.begin(), conditions.end(), Condition::cplusplus) != conditions.end();
  }

  // Keeps the stack of conditionals. True: the line itself is about __cplusplus and goes no further.
  static bool follow_cplusplus(std::string_view directive, std::string_view rest, std::vector<Condition>& stack) {
    const bool hidden = for_cplusplus(stack);
    if (directive == "ifdef" || directive == "ifndef" || directive == "if") {
      Condition condition = Condition::ordinary;
      if (!hidden && directive == "ifdef" && rest == "__cplusplus") condition = Condition::cplusplus;
      if (!hidden && directive == "ifndef" && rest == "__cplusplus") condition = Condition::not_cplusplus;
      stack.push_back(condition);
      return condition != Condition::ordinary;
    }
    if (stack.empty() || (directive != "else" && directive != "endif")) return false;
    const Condition top = stack.back();
    if (directive == "endif") stack.pop_back();
    if (top == Condition::ordinary) return false;
    if (directive == "else") {
      stack.back() = top == Condition::cplusplus ? Condition::not_cplusplus : Condition::cplusplus;
    }
    return true;
  }

  Result<void> include(std::string_view rest, const SourceFile& from, int line, int depth_of_conditions) {
    const auto where = [&] { return fmt::format("{}:{}: ", from.name, line); };
    if (rest.size() > 2 && rest.front() == '<') return {};  // a C++ header
    if (rest.size() < 3 || rest.front() != '"' || rest.back() != '"') {
      return failure(where() + "expected #include \"path/from/the/data/root.glsl\"");
    }
    const std::string name(rest.substr(1, rest.size() - 2));
    SourceFile file{name, {}};
    if (auto found = find_data(name)) {
      file.path = *found;
    } else if (std::filesystem::path beside = from.path.parent_path() / name;
               std::filesystem::is_regular_file(beside)) {
      file.path = beside;
      file.name = (std::filesystem::path(from.name).parent_path() / name).lexically_normal().generic_string();
    } else {
      index_of(file);  // so that a reload notices when it appears
      return failure(fmt::format("{}cannot find \"{}\": {}", where(), name, found.error().message));
    }
    const std::size_t index = index_of(file);
    if (const auto at = std::find(stack_.begin(), stack_.end(), index); at != stack_.end()) {
      std::string chain;
      for (auto i = at; i != stack_.end(); ++i) chain += files_[*i].name + " -> ";
      return failure(fmt::format("{}#include goes round in a circle: {}{}", where(), chain, file.name));
    }
    if (std::find(taken_always_.begin(), taken_always_.end(), index) != taken_always_.end()) return {};
    if (depth_of_conditions == 0) return add(file, 0);
    // Under an #if the text may be skipped by the driver, so a later include must bring it again: guard it in GLSL.
    output += fmt::format("#ifndef PETRICHOR_INCLUDED_{0}\n#define PETRICHOR_INCLUDED_{0}\n", index);
    if (auto done = add(file, depth_of_conditions); !done) return done;
    output += "#endif\n";
    return {};
  }

  std::size_t index_of(const SourceFile& file) {
    for (std::size_t i = 0; i < files_.size(); ++i) {
      if (files_[i].path == file.path && (!file.path.empty() || files_[i].name == file.name)) return i;
    }
    files_.push_back(file);
    return files_.size() - 1;
  }

  void line_marker(int line, std::size_t index) { output += fmt::format("#line {} {}\n", line, index); }

  std::vector<SourceFile>& files_;
  std::vector<std::size_t> stack_;
  std::vector<std::size_t> taken_always_;  // included outside any condition
};

}  // namespace

Result<ShaderSource> read_shader(std::string_view name, std::span<const std::string> defines,
                                 std::vector<SourceFile>* files) {
  std::vector<SourceFile> own;
  std::vector<SourceFile>& list = files ? *files : own;
  list.clear();
  SourceFile main{std::string(name), {}};
  if (auto found = find_data(main.name)) {
    main.path = *found;
  } else {
    list.push_back(main);
    return failure(fmt::format("{}: no such shader: {}", name, found.error().message));
  }
  Reader reader(list);
  if (auto done = reader.add(main, 0); !done) return tl::unexpected(done.error());

  std::string head = (reader.version.empty() ? "#version 450 core" : reader.version) + "\n";
  for (const std::string& define : defines) {
    const bool has_value = define.find(' ') != define.npos;
    head += fmt::format("#define {}{}\n", define, has_value ? "" : " 1");
  }
  head += "#line 1 0\n";
  return ShaderSource{head + reader.output, list};
}

std::string map_shader_log(std::string_view log, std::span<const SourceFile> files) {
  // Mesa 0:12(5): error: ...   NVIDIA 0(12) : error C1008: ...   others ERROR: 0:12: ...
  static const std::regex pattern(
      R"(^(?:(ERROR|WARNING): )?(\d{1,6})(?::(\d{1,9})\(\d+\): |\((\d{1,9})\) : |:(\d{1,9}): ))");
  std::string out;
  std::istringstream lines{std::string(log)};
  std::string line;
  while (std::getline(lines, line)) {
    while (!line.empty() && (line.back() == '\r' || line.back() == '\0')) line.pop_back();
    if (line.empty()) continue;
    std::smatch match;
    if (std::regex_search(line, match, pattern)) {
      const std::size_t file = std::stoul(match[2]);
      const std::string number = match[3].matched ? match[3] : match[4].matched ? match[4] : match[5];
      const std::string kind = match[1].matched ? (match[1] == "ERROR" ? "error: " : "warning: ") : "";
      if (file < files.size()) line = fmt::format("{}:{}: {}{}", files[file].name, number, kind, match.suffix().str());
    }
    if (!out.empty()) out += '\n';
    out += line;
  }
  return out;
}

}  // namespace petrichor
