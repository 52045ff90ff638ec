// The JSON document of a run: docs/schema/run.schema.json.
#pragma once

#include <slideway/io/json.hpp>

#include "recording.hpp"

namespace slideway::app {

io::Json run_document(const Recording& recording);

}  // namespace slideway::app
