# The page of `catena view`, from apps/viewer into the library.
#
#   src/*.ts  --esbuild-->  viewer.js  --+ page.html, style.css-->  viewer.html  --bytes-->  viewer_template.cpp
#
# catena_embed_viewer(<variable>) sets the variable to the source file that defines viewer_template(). Without
# CATENA_WITH_VIEWER that function returns nothing, and `catena view` says so.
function(catena_embed_viewer variable)
  set(output "${CMAKE_CURRENT_BINARY_DIR}/viewer_template.cpp")
  set(${variable} "${output}" PARENT_SCOPE)
  set(script "${CMAKE_CURRENT_FUNCTION_LIST_DIR}/embed_page.cmake")
  if(NOT CATENA_WITH_VIEWER)
    file(CONFIGURE OUTPUT "${output}" @ONLY CONTENT
[[// This library was built without the viewer.
#include "catena/scene/viewing/viewer_page.hpp"

std::string_view catena::viewer_template() { return {}; }
]])
    return()
  endif()
  find_program(CATENA_ESBUILD esbuild)
  mark_as_advanced(CATENA_ESBUILD)
  if(NOT CATENA_ESBUILD)
    message(FATAL_ERROR "catena: esbuild not found. Install the Debian package esbuild or configure with "
                        "-DCATENA_WITH_VIEWER=OFF.")
  endif()
  set(viewer "${PROJECT_SOURCE_DIR}/apps/viewer")
  file(GLOB sources CONFIGURE_DEPENDS "${viewer}/src/*.ts")
  set(bundle "${CMAKE_CURRENT_BINARY_DIR}/viewer.js")
  set(page "${CMAKE_CURRENT_BINARY_DIR}/viewer.html")
  add_custom_command(
    OUTPUT "${output}"
    COMMAND "${CATENA_ESBUILD}" "${viewer}/src/main.ts" --bundle --minify --target=es2020 --charset=utf8
            --log-level=warning "--outfile=${bundle}"
    COMMAND "${CMAKE_COMMAND}" "-DHTML=${viewer}/page.html" "-DSTYLE=${viewer}/style.css" "-DSCRIPT=${bundle}"
            "-DPAGE=${page}" "-DOUTPUT=${output}" -P "${script}"
    DEPENDS ${sources} "${viewer}/page.html" "${viewer}/style.css" "${script}"
    COMMENT "The viewer page"
    VERBATIM)
endfunction()
