# How every target of the project is compiled.
#
# -O3 in every build type: element derivatives come from templates on the scalar that are 8-15 times slower than closed
# forms at -O2 and 1.3-1.6 times at -O3. No -ffast-math: NaN and the order of sums carry meaning here.
# -fno-math-errno lets sqrt and friends vectorise and changes no value; -fno-semantic-interposition lets functions be
# inlined within a position-independent unit.
function(catena_set_flags target)
  target_compile_features(${target} PUBLIC cxx_std_20)
  set_target_properties(${target} PROPERTIES CXX_EXTENSIONS OFF POSITION_INDEPENDENT_CODE ON)
  target_compile_options(${target} PRIVATE -Wall -Wextra -Wpedantic -Wshadow -fno-math-errno
                                              -fno-semantic-interposition)
  # g++ 12 finds overlaps and overflows that are not there in its own std::string at -O3 (GCC bug 105651): those in
  # precompiled headers are not recognised as the system's. Clang and the sanitizers look for them as well.
  if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU" AND CMAKE_CXX_COMPILER_VERSION VERSION_LESS 13)
    target_compile_options(${target} PRIVATE -Wno-restrict -Wno-array-bounds -Wno-stringop-overflow
                                             -Wno-stringop-overread)
  endif()
  # Several files at once take g++ some 1 GB. Collecting its garbage below that (in kB) takes it 6 to 13 % of its time and
  # spares 10 to 20 % of the memory.
  if(CATENA_BATCH AND CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
    target_compile_options(${target} PRIVATE --param=ggc-min-heapsize=1000000)
  endif()
  if(CATENA_WERROR)
    target_compile_options(${target} PRIVATE -Werror)
  endif()
  if(CATENA_NATIVE)
    target_compile_options(${target} PRIVATE -march=native)
    # g++ 12 takes the undefined lanes of its own AVX-512 intrinsics for uninitialized variables (GCC bug 105593).
    if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU" AND CMAKE_CXX_COMPILER_VERSION VERSION_LESS 13)
      target_compile_options(${target} PRIVATE -Wno-maybe-uninitialized -Wno-uninitialized)
    endif()
  endif()
  if(CATENA_SANITIZE)
    set(sanitizers -fsanitize=address,undefined -fno-sanitize-recover=all -fno-omit-frame-pointer)
    # A null, freed or overrun address is found by AddressSanitizer where it is used. What the other sanitizer asks before
    # every access besides takes a third of the compile time and half of the code.
    list(APPEND sanitizers -fno-sanitize=null,alignment,object-size,vptr)
    # Clang objects to the address of an empty block of an empty matrix, which Eigen computes and does not use.
    if(CMAKE_CXX_COMPILER_ID MATCHES "Clang")
      list(APPEND sanitizers -fno-sanitize=pointer-overflow)
    endif()
    target_compile_options(${target} PRIVATE -O1 ${sanitizers})
    target_link_options(${target} PRIVATE ${sanitizers})
    # The tests, 130 MB each, are linked in a quarter of the time by the linker that comes with clang, where it is there.
    find_program(CATENA_LLD ld.lld)
    mark_as_advanced(CATENA_LLD)
    if(CATENA_LLD AND CMAKE_CXX_COMPILER_ID MATCHES "Clang")
      target_link_options(${target} PRIVATE -fuse-ld=lld)
    endif()
  else()
    target_compile_options(${target} PRIVATE -O3)
  endif()
endfunction()

# With CATENA_BATCH: up to ten files of a folder at once; their headers and what these hold are compiled once. Names that a
# file hides in its unnamed namespace must differ from those of its folder, or be the same thing in a header.
function(catena_batch target)
  if(NOT CATENA_BATCH)
    return()
  endif()
  get_target_property(sources ${target} SOURCES)
  list(SORT sources)
  set(folder "")
  foreach(source IN LISTS sources)
    get_filename_component(here "${source}" DIRECTORY)
    if(NOT here STREQUAL folder)
      set(folder "${here}")
      set(place 0)
    endif()
    math(EXPR group "${place} / 10")
    math(EXPR place "${place} + 1")
    string(MAKE_C_IDENTIFIER "${here}_${group}" group)
    set_source_files_properties("${source}" PROPERTIES UNITY_GROUP ${group})
  endforeach()
  set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_MODE GROUP)
  target_compile_options(${target} PRIVATE -Wno-shadow)
endfunction()
