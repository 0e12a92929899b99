# One dialect for every room: C++20, warnings as errors, and arithmetic that gives the same bits on
# every processor (no contraction into fused multiply-add, no fast-math).
set(CMAKE_CXX_STANDARD 20)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_EXPORT_COMPILE_COMMANDS ON)

find_program(CCACHE ccache)
if(CCACHE)
  # Paths count from the checkout, so that another checkout finds what this one has compiled.
  set(CMAKE_CXX_COMPILER_LAUNCHER
    ${CMAKE_COMMAND} -E env CCACHE_BASEDIR=${CMAKE_SOURCE_DIR} CCACHE_NOHASHDIR=1 ${CCACHE})
endif()
find_package(PkgConfig REQUIRED)
find_package(Threads REQUIRED)
find_package(nlohmann_json REQUIRED)

add_compile_options(-Wall -Wextra -Wpedantic -Wconversion -Wshadow -Wno-missing-field-initializers -Werror -ffp-contract=off)
if(FUDE_SANITIZE)
  add_compile_options(-fsanitize=${FUDE_SANITIZE} -fno-sanitize-recover=all -fno-omit-frame-pointer)
  add_link_options(-fsanitize=${FUDE_SANITIZE})
  if(CMAKE_CXX_COMPILER_ID STREQUAL GNU)
    add_compile_options(-Wno-maybe-uninitialized)  # GCC 12 sees ghosts in instrumented library headers
  endif()
endif()

# fude_room(NAME SOURCES … LINKS …): a static library whose headers are included from the root.
function(fude_room name)
  cmake_parse_arguments(ROOM "" "" "SOURCES;LINKS" ${ARGN})
  add_library(fude_${name} STATIC ${ROOM_SOURCES})
  target_include_directories(fude_${name} PUBLIC ${PROJECT_SOURCE_DIR})
  target_link_libraries(fude_${name} PUBLIC ${ROOM_LINKS})
endfunction()

# fude_package(NAME MODULE): a pkg-config module as a target whose headers count as the system's.
function(fude_package name module)
  if(NOT TARGET fude_${name})
    pkg_check_modules(${name} REQUIRED ${module})
    add_library(fude_${name} INTERFACE IMPORTED GLOBAL)
    target_include_directories(fude_${name} SYSTEM INTERFACE ${${name}_INCLUDE_DIRS})
    target_link_libraries(fude_${name} INTERFACE ${${name}_LINK_LIBRARIES})
  endif()
endfunction()
