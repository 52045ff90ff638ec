// What `slideway verify` prints and writes.
#pragma once

#include <slideway/io/json.hpp>
#include <string>

#include "verification.hpp"

namespace slideway::app {

std::string verify_table(const Verification& verification);

/// docs/schema/verify.schema.json
io::Json verify_document(const Verification& verification);

}  // namespace slideway::app
