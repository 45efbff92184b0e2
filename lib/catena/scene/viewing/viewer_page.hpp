// The page of `catena view`: built from apps/viewer, kept in the library, given its data when it is written.
//
// One HTML file without outside references. The data stand in a script element of the type application/json, where
// "<" is written as \u003c: no name in a scene can end the element or become markup.
#pragma once

#include <string>
#include <string_view>

namespace catena {

/// The page without data; empty in a library that was built without it (CATENA_WITH_VIEWER=OFF).
std::string_view viewer_template();

/// The page with its data, a document of view_document(). viewer_template() must not be empty.
std::string compose_page(std::string_view document);

}  // namespace catena
