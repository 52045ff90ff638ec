// What a controller has to set aside for the compile-time crank-rocker: state, scene and work memory, stack, and no
// heap.
#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <slideway/scenes/crank_rocker.hpp>
#include <slideway/scenes/gantry.hpp>
#include <slideway/scenes/squeezer.hpp>
#include <slideway/step.hpp>
#include <string>
#include <vector>

#include "support/allocations.hpp"

namespace {

using slideway::Method;
using slideway::Stepper;

constexpr std::size_t kibibyte = 1024;

TEST(Memory, StateSceneAndWorkOfTheCrankRockerFitInFourKibibytes) {
  using Known = Stepper<crank_rocker>;
  // The scene and its tables are constants, most of which the compiler folds away; they count as if none were. Work is
  // what one evaluation has in hand, on the stack.
  const std::size_t state = sizeof(Known::State), inputs = sizeof(Known::Inputs);
  const std::size_t scene = sizeof(crank_rocker) + sizeof(Known{}.source.tables) + sizeof(Known);
  const std::size_t work = sizeof(slideway::Work<Known::Size>) + sizeof(Known::Reaction) + sizeof(slideway::Report);
  EXPECT_LE(state + inputs + scene + work, 4 * kibibyte);
  RecordProperty("state", static_cast<int>(state + inputs));
  RecordProperty("scene", static_cast<int>(scene));
  RecordProperty("work", static_cast<int>(work));
}

/// A program's functions with their stack frames, and who calls whom, as g++ -fcallgraph-info=su writes them.
struct CallGraph {
  struct Function {
    std::string name;
    std::size_t frame = 0;  ///< bytes
    bool bounded = true;
    std::vector<std::string> calls;
  };
  std::map<std::string, Function> functions;

  /// The i-th of the quoted strings of a line.
  static std::string quoted(const std::string& line, int i) {
    std::size_t from = line.find('"');
    for (; i > 0 && from != std::string::npos; --i) from = line.find('"', line.find('"', from + 1) + 1);
    return from == std::string::npos ? "" : line.substr(from + 1, line.find('"', from + 1) - from - 1);
  }

  /// Lines  node: { title: "t.cpp:_Z4step" label: "step()\nt.cpp:3:4\n592 bytes (static)" }
  /// and    edge: { sourcename: "t.cpp:_Z4step" targetname: "t.cpp:_Z5solve" label: "t.cpp:7:8" }
  static CallGraph read(const std::filesystem::path& file) {
    CallGraph graph;
    std::ifstream in(file);
    for (std::string line; std::getline(in, line);) {
      if (line.rfind("node:", 0) == 0) {
        Function& function = graph.functions[quoted(line, 0)];
        const std::string label = quoted(line, 1);
        function.name = label.substr(0, label.find("\\n"));
        const std::size_t bytes = label.find(" bytes (");
        if (bytes == std::string::npos) continue;  // of another program: the C library
        function.frame = std::stoul(label.substr(label.rfind("\\n", bytes) + 2));
        function.bounded = label.find("(static)") != std::string::npos || label.find(",bounded)") != std::string::npos;
      } else if (line.rfind("edge:", 0) == 0) {
        graph.functions[quoted(line, 0)].calls.push_back(quoted(line, 1));
      }
    }
    return graph;
  }

  /// Frames of the deepest chain of calls from `function`, a return address of 8 bytes each, and the chain. A chain of
  /// more than 100 calls is a recursion.
  std::size_t depth(const std::string& function, std::string& chain, int calls = 0) const {
    const auto found = functions.find(function);
    if (found == functions.end()) return 0;
    EXPECT_LT(calls, 100) << "recursion through " << found->second.name;
    if (calls >= 100) return 0;
    EXPECT_TRUE(found->second.bounded) << found->second.name;
    std::size_t deepest = 0;
    std::string rest;
    for (const std::string& callee : found->second.calls) {
      std::string below;
      const std::size_t bytes = depth(callee, below, calls + 1);
      if (bytes < deepest) continue;
      deepest = bytes;
      rest = below;
    }
    chain = "\n  " + std::to_string(found->second.frame) + " " + found->second.name.substr(0, 90) + rest;
    return found->second.frame + 8 + deepest;
  }
};

TEST(Memory, AStepOfTheCrankRockerNeedsTwelveKibibytesOfStack) {
  // Sliding alone needs a third of it; what is deepest is a guide that stops, asked at rest, an HLCP of order 3 decided
  // exactly. g++ only: clang has no call graph with frames. What is counted: all chains of calls of one step by any
  // method, refused or not, at the optimisation of the release; not the C library's sin, cos and sqrt.
  if (std::system("g++ --version > /dev/null 2>&1") != 0) GTEST_SKIP() << "g++ is not installed";
  const auto directory = std::filesystem::path(testing::TempDir()) / ("slideway_memory_" + std::to_string(::getpid()));
  std::filesystem::create_directories(directory);
  std::ofstream(directory / "step.cpp") << R"(
    #include <slideway/scenes/crank_rocker.hpp>
    #include <slideway/step.hpp>
    using Stepper = slideway::Stepper<crank_rocker>;
    slideway::Report take_step(const Stepper& stepper, Stepper::State& state, double dt, const Stepper::Inputs& in) {
      return stepper.step(state, dt, in);
    })";
  const std::string command =
      "cd '" + directory.string() +
      "' && g++ -std=c++17 -O3 -DNDEBUG -ffp-contract=off -fno-exceptions -fno-rtti -fstack-usage -fcallgraph-info=su "
      "-I'" SLIDEWAY_SOURCE_DIR "/kernel' -I'" SLIDEWAY_BUILD_DIR "/generated' -c step.cpp";
  ASSERT_EQ(std::system(command.c_str()), 0) << command;
  const CallGraph graph = CallGraph::read(directory / "step.ci");
  std::size_t bytes = 0;
  std::string chain;
  for (const auto& [title, function] : graph.functions) {
    if (title.find("take_step") != std::string::npos) bytes = graph.depth(title, chain);
  }
  std::filesystem::remove_all(directory);
  EXPECT_GT(bytes, 256u) << "the call graph was not understood";  // four stages of two coordinates are more than that
  EXPECT_LE(bytes, 12 * kibibyte) << "deepest chain of calls:" << chain;
  RecordProperty("stack", static_cast<int>(bytes));
}

template <const auto& scene>
void expect_no_heap(const char* what, double dt) {
  Stepper<scene> stepper;
  for (const Method method : slideway::methods) {
    stepper.method = method;
    auto state = stepper.start();
    typename Stepper<scene>::Reaction reaction;
    const std::size_t before = slideway::test::allocations();
    stepper.project(state);
    for (int k = 0; k < 20; ++k) {
      stepper.step(state, dt);
      stepper.reaction(state, {}, reaction);
    }
    stepper.step(state, -1);  // refused
    EXPECT_EQ(slideway::test::allocations() - before, 0u) << what << " " << name(method);
    EXPECT_TRUE(state.steps == 20 || method == Method::kinematic) << what << " " << name(method);
  }
}

TEST(Memory, CompileTimeScenesAskNothingOfTheHeap) {
  if (!slideway::test::allocations_are_counted()) GTEST_SKIP() << "not counted: not glibc, or a sanitizer's malloc";
  expect_no_heap<crank_rocker>("crank_rocker", 1e-3);
  expect_no_heap<gantry>("gantry", 1e-3);
  expect_no_heap<squeezer>("squeezer", 5e-6);
}

}  // namespace
