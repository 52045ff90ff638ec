// slideway chart, slideway atlas: handed to a program of its own, slideway-charts, which has what it measures beside
// the kernel linked in.
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>

#include "messages.hpp"
#include "verbs.hpp"

namespace slideway::app {
namespace {

constexpr const char* program = "slideway-charts";

/// Does not return where the program is found: beside this one, or on the path.
int hand_over(const std::string& verb, std::vector<std::string> rest) {
  namespace fs = std::filesystem;
  std::error_code unknown;
  const fs::path beside = fs::read_symlink("/proc/self/exe", unknown).parent_path() / program;
  std::string name = program, first = verb;
  std::vector<char*> arguments{name.data(), first.data()};
  for (std::string& argument : rest) arguments.push_back(argument.data());
  arguments.push_back(nullptr);
  if (!unknown) execv(beside.c_str(), arguments.data());
  execvp(program, arguments.data());
  complain("slideway {}: {} is neither beside this program nor on the path ({}); ./dev charts builds it", verb, program,
           std::strerror(errno));
  return bad_input;
}

void add(CLI::App& command, const char* name, const char* description, int& status) {
  CLI::App* verb = command.add_subcommand(name, description);
  verb->set_help_flag();  // --help is the program's, too
  verb->prefix_command();
  verb->callback([=, &status] { status = hand_over(name, verb->remaining()); });
}

}  // namespace

void add_charts(CLI::App& command, int& status) {
  add(command, "chart", "Chart a scene's error against time, for every method and what else there is", status);
  add(command, "atlas", "Map where methods fail", status);
}

}  // namespace slideway::app
