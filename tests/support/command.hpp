// Tests that run the slideway command.
#pragma once

#include <gtest/gtest.h>
#include <stdlib.h>
#include <sys/wait.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>

namespace test {

namespace fs = std::filesystem;

inline std::string read(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}
inline void write(const fs::path& file, const std::string& text) { std::ofstream(file, std::ios::binary) << text; }

struct Result {
  int status;
  std::string out, err;
};

/// Runs shell words, with a directory of the test's own as $TMP.
class CommandTest : public testing::Test {
 protected:
  CommandTest() {
    std::string pattern = (fs::temp_directory_path() / "slideway_XXXXXX").string();
    tmp = mkdtemp(pattern.data());
  }
  ~CommandTest() override { fs::remove_all(tmp); }

  Result shell(const std::string& words, const fs::path& directory) const {
    const fs::path out = tmp / "stdout", err = tmp / "stderr";
    const std::string line = "cd '" + directory.string() + "' && export TMP='" + tmp.string() + "' && " + words +
                             " >'" + out.string() + "' 2>'" + err.string() + "'";
    const int status = std::system(line.c_str());
    return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, read(out), read(err)};
  }
  Result slideway(const std::string& arguments, const fs::path& directory) const {
    return shell("'" SLIDEWAY_COMMAND "' " + arguments, directory);
  }

  /// Documents of a test's own directory, by a shell pattern, are as docs/schema/NAME.schema.json says.
  void hold_to_schema(const std::string& name, const std::string& documents) const {
    write(tmp / "hold.py", R"(import json, sys
import jsonschema
schema = json.load(open(sys.argv[1]))
jsonschema.Draft202012Validator.check_schema(schema)
for name in sys.argv[2:]:
    jsonschema.validate(json.load(open(name)), schema, cls=jsonschema.Draft202012Validator)
)");
    ASSERT_EQ(shell("python3 -c 'import jsonschema'", tmp).status, 0) << "this test needs Debian's python3-jsonschema";
    const std::string schema = SLIDEWAY_SOURCE_DIR "/docs/schema/" + name + ".schema.json";
    const Result held = shell("python3 hold.py '" + schema + "' " + documents, tmp);
    EXPECT_EQ(held.status, 0) << held.err;
  }

  fs::path tmp;
};

}  // namespace test
