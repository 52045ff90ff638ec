// A file that the command writes: opened before the work, closed after it, and a failure in between is remembered.
#pragma once

#include <fstream>
#include <iosfwd>
#include <string>
#include <string_view>
#include <vector>

namespace slideway::app {

class Output {
 public:
  /// "" writes nowhere; "-" is standard output.
  explicit Output(std::string file) : file_(std::move(file)) {}

  bool wanted() const noexcept { return !file_.empty(); }
  bool standard() const noexcept { return file_ == "-"; }
  const std::string& file() const noexcept { return file_; }

  /// False, and said on standard error, when it cannot be opened. can_open() leaves what the file has.
  bool can_open() const;
  bool open();
  void write(std::string_view text);
  std::ostream& stream();
  /// False, and said on standard error, when anything since open() failed.
  bool close();

 private:
  void note_failure();

  std::string file_;
  std::ofstream stream_;
  int error_ = 0;  ///< errno of the first failure
  bool failed_ = false;
};

/// False, and said on standard error, when two outputs are one file, or one of them is the scene's own.
bool distinct(const std::vector<const Output*>& outputs, const std::string& scene);

/// Opens all that are wanted, or none: then every file keeps what it has.
bool open_all(const std::vector<Output*>& outputs, const std::string& scene);

}  // namespace slideway::app
