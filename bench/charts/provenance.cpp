#include "provenance.hpp"

#include <fmt/format.h>

#include <cstdio>
#include <fstream>
#include <memory>
#include <thread>

namespace slideway::charts {
namespace {

std::string processor() {
  std::ifstream file("/proc/cpuinfo");
  for (std::string text; std::getline(file, text);) {
    const std::size_t colon = text.find(": ");
    if (text.starts_with("model name") && colon != text.npos) return text.substr(colon + 2);
  }
  return "unknown processor";
}

/// The first line that a command prints.
std::string first_line_of(const std::string& command) {
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> pipe(popen(command.c_str(), "r"), pclose);
  char text[128] = {};
  if (!pipe || std::fgets(text, sizeof text, pipe.get()) == nullptr) return "";
  std::string line = text;
  while (!line.empty() && line.back() == '\n') line.pop_back();
  return line;
}

std::string compiler() {
#ifdef __clang__
  return "clang++ " + std::to_string(__clang_major__) + "." + std::to_string(__clang_minor__) + " " SLIDEWAY_FLAGS;
#else
  return "g++ " + std::to_string(__GNUC__) + "." + std::to_string(__GNUC_MINOR__) + " " SLIDEWAY_FLAGS;
#endif
}

}  // namespace

Provenance provenance(const std::string& command, const std::string& root) {
  const std::string git = "git -C '" + root + "' ";
  std::string commit = first_line_of(git + "rev-parse --short HEAD 2>/dev/null");
  const std::string changed = first_line_of(git + "status --porcelain -- kernel io oracle bench/charts 2>/dev/null");
  if (!commit.empty() && !changed.empty()) commit += '+';
  return {command, fmt::format("{}, {} cores", processor(), std::thread::hardware_concurrency()), compiler(), commit};
}

std::string line(const Provenance& made) {
  return fmt::format("{} · {}{}{} · {}", made.command, made.commit, made.commit.empty() ? "" : " · ", made.compiler,
                     made.machine);
}

io::Json document(const Provenance& made) {
  return {{"command", made.command}, {"machine", made.machine}, {"compiler", made.compiler}, {"commit", made.commit}};
}

}  // namespace slideway::charts
