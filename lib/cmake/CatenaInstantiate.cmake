# One translation unit in the build tree for every element header: the scalars an element is needed for are a closed
# list, instantiated once each (extern template), so that the compile time of an element is paid in one place and
# touching one element rebuilds one unit.
#
# catena_instantiate_elements(<out-variable> <folder under lib/catena/elements> <macro>)

function(catena_instantiate_elements out folder macro)
  set(sources)
  file(GLOB instantiate CONFIGURE_DEPENDS "${PROJECT_SOURCE_DIR}/lib/catena/assembly/instantiate.hpp")
  file(GLOB headers CONFIGURE_DEPENDS RELATIVE "${PROJECT_SOURCE_DIR}/lib"
       "${PROJECT_SOURCE_DIR}/lib/catena/elements/${folder}/*.hpp")
  if(instantiate)
    foreach(CATENA_HEADER IN LISTS headers)
      get_filename_component(name "${CATENA_HEADER}" NAME_WE)
      # absolute_x -> AbsoluteX
      set(CATENA_TYPE "")
      string(REPLACE "_" ";" words "${name}")
      foreach(word IN LISTS words)
        string(SUBSTRING "${word}" 0 1 first)
        string(SUBSTRING "${word}" 1 -1 rest)
        string(TOUPPER "${first}" first)
        string(APPEND CATENA_TYPE "${first}${rest}")
      endforeach()
      # A header of shared helpers defines no type of its own name and needs no unit.
      file(STRINGS "${PROJECT_SOURCE_DIR}/lib/${CATENA_HEADER}" definition REGEX "struct ${CATENA_TYPE}( |{|$)")
      if(definition)
        set(CATENA_MACRO ${macro})
        set(source "${PROJECT_BINARY_DIR}/instantiate/${folder}/${name}.cpp")
        configure_file("${PROJECT_SOURCE_DIR}/lib/cmake/instantiate.cpp.in" "${source}" @ONLY)
        list(APPEND sources "${source}")
      else()
        set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS "${PROJECT_SOURCE_DIR}/lib/${CATENA_HEADER}")
      endif()
    endforeach()
  endif()
  set(${out} ${sources} PARENT_SCOPE)
endfunction()
