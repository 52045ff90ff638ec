// What every target has: a name, an entry, and one line when something does not hold.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

namespace slideway::fuzz {

extern const char* const target;  ///< its name; each target defines its own

/// Prints what does not hold and how to see it again, in one line, and aborts.
[[noreturn]] void fail(const std::string& what);

}  // namespace slideway::fuzz

/// The entry that libFuzzer, AFL++ and replay.cpp call.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);
