// A target without a fuzzing engine: tries every file that it is given, and every file below a directory.
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "support/fail.hpp"

namespace {

namespace fs = std::filesystem;

std::vector<fs::path> files_of(const fs::path& given) {
  std::vector<fs::path> files;
  if (!fs::is_directory(given)) return {given};
  for (const auto& entry : fs::recursive_directory_iterator(given)) {
    if (entry.is_regular_file()) files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  return files;
}

bool try_file(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  const std::string bytes((std::istreambuf_iterator<char>(in)), {});
  if (!in) {
    std::fprintf(stderr, "%s: cannot be read\n", file.c_str());
    return false;
  }
  std::printf("%s\n", file.c_str());
  std::fflush(stdout);  // the last line names the file that fails
  // A copy of this very size, so that a sanitizer sees what is read beyond it.
  const std::vector<std::uint8_t> exactly(bytes.begin(), bytes.end());
  LLVMFuzzerTestOneInput(exactly.data(), exactly.size());
  return true;
}

}  // namespace

int main(int argc, char** argv) {
  int tried = 0;
  for (int k = 1; k < argc; ++k) {
    for (const fs::path& file : files_of(argv[k])) {
      if (!try_file(file)) return 2;
      ++tried;
    }
  }
  std::printf("%s: %d files\n", slideway::fuzz::target, tried);
  return tried > 0 ? 0 : 2;
}
