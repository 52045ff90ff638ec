#include <cstdio>
#include <exception>
#include <slideway/io/text.hpp>

#include "messages.hpp"
#include "verbs.hpp"

namespace slideway::app {

namespace {

std::string no_such_verb(const CLI::App& command, const std::string& verb) {
  std::vector<std::string> verbs;
  for (const CLI::App* one : command.get_subcommands({})) verbs.push_back(one->get_name());
  return io::quote(verb) + " is not a verb" + io::suggestion(verb, verbs);
}

int command(int count, char** arguments) {
  CLI::App command("Planar mechanisms with frictional guides, stepped with certified contact forces.", "slideway");
  command.set_version_flag("--version", "slideway " SLIDEWAY_VERSION);
  command.require_subcommand(1);
  int status = good;
  add_run(command, status);
  add_verify(command, status);
  add_lint(command, status);
  add_hlcp(command, status);
  add_export(command, status);
  add_charts(command, status);
  add_scenes(command, status);
  try {
    command.parse(count, arguments);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) return command.exit(error);  // --help, --version
    const bool no_verb = command.get_subcommands().empty() && count > 1 && arguments[1][0] != '-';
    complain("slideway: {}", no_verb ? no_such_verb(command, arguments[1])
                                     : std::string(error.what()) + "; --help shows what there is");
    return bad_input;
  }
  return status;
}

}  // namespace
}  // namespace slideway::app

int main(int count, char** arguments) {
  try {
    return slideway::app::command(count, arguments);
  } catch (const std::exception& error) {  // no memory, for example
    std::fprintf(stderr, "slideway: %s\n", error.what());
    return slideway::app::bad_input;
  }
}
