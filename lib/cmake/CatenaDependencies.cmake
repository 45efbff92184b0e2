# Finds what libcatena links to and names it with imported targets catena_dep::<name>.
#
# Used by the project's own build (HEADERS: headers too) and by the installed package (libraries only, since no
# public header shows a dependency). Reads CATENA_WITH_UMFPACK, CATENA_WITH_SPQR, CATENA_WITH_IPOPT,
# CATENA_WITH_NLOPT; what is on and missing stops with the Debian package and the switch that leaves it out.
#
# Debian 12 ships SuiteSparse and Ipopt without CMake package files, hence the search by hand.

# catena_find_library(<name> <library> <header or ""> <package> <switch or "">)
function(catena_find_library name library header package switch)
  if(TARGET catena_dep::${name})
    return()
  endif()
  set(remedy "Install the Debian package ${package}")
  if(switch)
    string(APPEND remedy " or configure with -D${switch}=OFF")
  endif()
  find_library(CATENA_${name}_LIBRARY ${library})
  mark_as_advanced(CATENA_${name}_LIBRARY)
  if(NOT CATENA_${name}_LIBRARY)
    message(FATAL_ERROR "catena: library ${library} not found. ${remedy}.")
  endif()
  add_library(catena_dep::${name} UNKNOWN IMPORTED GLOBAL)
  set_target_properties(catena_dep::${name} PROPERTIES IMPORTED_LOCATION "${CATENA_${name}_LIBRARY}")
  if(header)
    find_path(CATENA_${name}_INCLUDE_DIR ${header} PATH_SUFFIXES suitesparse coin)
    mark_as_advanced(CATENA_${name}_INCLUDE_DIR)
    if(NOT CATENA_${name}_INCLUDE_DIR)
      message(FATAL_ERROR "catena: header ${header} not found. ${remedy}.")
    endif()
    target_include_directories(catena_dep::${name} SYSTEM INTERFACE "${CATENA_${name}_INCLUDE_DIR}")
  endif()
endfunction()

# catena_find_dependencies([HEADERS]): sets CATENA_DEPENDENCIES (targets to link) and CATENA_PC_LIBS (for pkg-config).
macro(catena_find_dependencies)
  cmake_parse_arguments(_catena "HEADERS" "" "" ${ARGN})
  set(CATENA_DEPENDENCIES)
  set(CATENA_PC_LIBS)
  set(_catena_libraries "umfpack|umfpack|umfpack.h|libsuitesparse-dev|CATENA_WITH_UMFPACK"
                        "spqr|spqr|SuiteSparseQR.hpp|libsuitesparse-dev|CATENA_WITH_SPQR"
                        "ipopt|ipopt|IpIpoptApplication.hpp|coinor-libipopt-dev|CATENA_WITH_IPOPT"
                        "nlopt|nlopt|nlopt.h|libnlopt-dev|CATENA_WITH_NLOPT"
                        "cholmod|cholmod|cholmod.h|libsuitesparse-dev|"
                        "klu|klu|klu.h|libsuitesparse-dev|"
                        "btf|btf|btf.h|libsuitesparse-dev|"
                        "amd|amd|amd.h|libsuitesparse-dev|"
                        "colamd|colamd|colamd.h|libsuitesparse-dev|"
                        "suitesparseconfig|suitesparseconfig|SuiteSparse_config.h|libsuitesparse-dev|"
                        "fmt|fmt|fmt/core.h|libfmt-dev|")
  foreach(_catena_entry IN LISTS _catena_libraries)
    string(REPLACE "|" ";" _catena_fields "${_catena_entry}")
    list(GET _catena_fields 0 _catena_name)
    list(GET _catena_fields 1 _catena_library)
    list(GET _catena_fields 2 _catena_header)
    list(GET _catena_fields 3 _catena_package)
    list(GET _catena_fields 4 _catena_switch)
    if(_catena_switch AND NOT ${_catena_switch})
      continue()
    endif()
    if(NOT _catena_HEADERS)
      set(_catena_header "")
    endif()
    catena_find_library("${_catena_name}" "${_catena_library}" "${_catena_header}" "${_catena_package}"
                        "${_catena_switch}")
    list(APPEND CATENA_DEPENDENCIES catena_dep::${_catena_name})
    list(APPEND CATENA_PC_LIBS -l${_catena_library})
  endforeach()

  # OpenBLAS is linked by name where present: SuiteSparse reaches BLAS by itself, but only OpenBLAS can be told to
  # stay on the calling thread, which small fronts need.
  find_library(CATENA_openblas_LIBRARY openblas)
  mark_as_advanced(CATENA_openblas_LIBRARY)
  if(NOT DEFINED CATENA_HAS_OPENBLAS)
    if(CATENA_openblas_LIBRARY)
      set(CATENA_HAS_OPENBLAS 1)
    else()
      set(CATENA_HAS_OPENBLAS 0)
    endif()
  endif()
  if(CATENA_HAS_OPENBLAS)
    catena_find_library(openblas openblas "" libopenblas-dev "")
    list(APPEND CATENA_DEPENDENCIES catena_dep::openblas)
    list(APPEND CATENA_PC_LIBS -lopenblas)
  endif()

  set(THREADS_PREFER_PTHREAD_FLAG ON)
  find_package(Threads REQUIRED)
  list(APPEND CATENA_DEPENDENCIES Threads::Threads)
  list(APPEND CATENA_PC_LIBS -pthread)
endmacro()
