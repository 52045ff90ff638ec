// What a figure was made with.
#pragma once

#include <slideway/io/json.hpp>
#include <string>

namespace slideway::charts {

struct Provenance {
  std::string command;   ///< that makes it again
  std::string machine;   ///< the processor's name and number of cores
  std::string compiler;  ///< with version and options
  std::string commit;    ///< of the sources, + where they were changed; empty outside a repository
};

/// Of this program, here and now; `root` is the source directory.
Provenance provenance(const std::string& command, const std::string& root);

/// In one line, for the foot of a figure.
std::string line(const Provenance& made);
io::Json document(const Provenance& made);

}  // namespace slideway::charts
