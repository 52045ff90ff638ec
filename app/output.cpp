#include "output.hpp"

#include <cerrno>
#include <filesystem>
#include <iostream>
#include <system_error>

#include "messages.hpp"

namespace slideway::app {
namespace {

std::string reason(int error) { return error != 0 ? std::generic_category().message(error) : "unknown reason"; }

bool same_file(const std::string& a, const std::string& b) {
  std::error_code error;
  const bool regular = std::filesystem::is_regular_file(a, error) || !std::filesystem::exists(a, error);
  return a == b ? regular : std::filesystem::equivalent(a, b, error) && regular;
}

}  // namespace

bool Output::can_open() const {
  if (!wanted() || standard()) return true;
  errno = 0;
  if (std::ofstream(file_, std::ios::binary | std::ios::app)) return true;
  complain("{}: cannot be written: {}", file_, reason(errno));
  return false;
}

bool Output::open() {
  if (!wanted() || standard()) return true;
  errno = 0;
  stream_.open(file_, std::ios::binary);
  if (stream_) return true;
  complain("{}: cannot be written: {}", file_, reason(errno));
  return false;
}

std::ostream& Output::stream() { return standard() ? std::cout : stream_; }

void Output::note_failure() {
  if (failed_ || stream()) return;
  failed_ = true;
  error_ = errno;
}

void Output::write(std::string_view text) {
  if (!wanted() || failed_) return;
  errno = 0;
  stream() << text;
  note_failure();
}

bool Output::close() {
  if (!wanted()) return true;
  errno = 0;
  stream().flush();
  note_failure();
  if (!standard()) stream_.close();
  note_failure();
  if (failed_) complain("{}: is incomplete, it cannot be written: {}", file_, reason(error_));
  return !failed_;
}

bool distinct(const std::vector<const Output*>& outputs, const std::string& scene) {
  for (std::size_t i = 0; i < outputs.size(); ++i) {
    if (!outputs[i]->wanted()) continue;
    if (!outputs[i]->standard() && same_file(outputs[i]->file(), scene)) {
      complain("{}: is the scene itself: write to another file", scene);
      return false;
    }
    for (std::size_t j = 0; j < i; ++j) {
      if (outputs[j]->wanted() && same_file(outputs[i]->file(), outputs[j]->file())) {
        complain("{}: is named for two outputs: give each its own", outputs[i]->file());
        return false;
      }
    }
  }
  return true;
}

bool open_all(const std::vector<Output*>& outputs, const std::string& scene) {
  if (!distinct({outputs.begin(), outputs.end()}, scene)) return false;
  bool good = true;
  for (const Output* output : outputs) good = output->can_open() && good;
  for (Output* output : outputs) good = good && output->open();
  return good;
}

}  // namespace slideway::app
