// The definitions of the JSON Schema that depend on no list of types: numbers, functions of time, curves, attachments.
#pragma once

#include <string_view>

namespace catena {

/// A JSON object: name -> schema.
std::string_view fixed_definitions();

}  // namespace catena
