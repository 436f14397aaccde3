# What keeps a build short: docs/decisions/0025-compile-time.md has the figures. A product is built
# without any of it; so it also proves that every file includes what it uses.

# kagami_quick_sources(FILE...), kagami_quick_target(TARGET): seldom run, so compiled for the
# compiler's time: command lines, JSON, reports. Never what runs for each frame, packet or picture.
set(kagami_quick_options "")
if(KAGAMI_ASSERT AND NOT KAGAMI_PRODUCT)
  set(kagami_quick_options -O1)
endif()
function(kagami_quick_sources)
  set_source_files_properties(${ARGN} PROPERTIES COMPILE_OPTIONS "${kagami_quick_options}")
endfunction()
function(kagami_quick_target TARGET)
  target_compile_options(${TARGET} PRIVATE ${kagami_quick_options})
endfunction()

# kagami_headers(NAME <header>...): a library that exists for its precompiled header only.
function(kagami_headers NAME)
  set(source ${CMAKE_CURRENT_BINARY_DIR}/${NAME}.cpp)
  file(CONFIGURE OUTPUT ${source} CONTENT "// carries a precompiled header\n")
  add_library(${NAME} OBJECT ${source})
  target_include_directories(${NAME} PRIVATE ${PROJECT_SOURCE_DIR})
  target_link_libraries(${NAME} PRIVATE kagami_warnings)
  target_precompile_headers(${NAME} PRIVATE ${ARGN})
endfunction()

set(kagami_std_headers
  <algorithm> <array> <atomic> <chrono> <cmath> <expected> <filesystem> <fstream> <functional> <map>
  <memory> <mutex> <numbers> <optional> <random> <span> <string> <string_view> <thread> <vector>)

# Every target below FOLDER that has no precompiled header gets that of the standard library.
function(kagami_precompile_below FOLDER)
  get_property(targets DIRECTORY ${FOLDER} PROPERTY BUILDSYSTEM_TARGETS)
  foreach(target ${targets})
    get_target_property(type ${target} TYPE)
    if(NOT type MATCHES "^(STATIC_LIBRARY|EXECUTABLE)$")
      continue()
    endif()
    get_target_property(own ${target} PRECOMPILE_HEADERS)
    get_target_property(reused ${target} PRECOMPILE_HEADERS_REUSE_FROM)
    # Another code model, or a program without position: g++ refuses the header then.
    get_target_property(pic ${target} POSITION_INDEPENDENT_CODE)
    # Aravis' pkg-config file says -pthread, and g++ then refuses headers compiled without it.
    get_target_property(libraries ${target} LINK_LIBRARIES)
    get_target_property(disabled ${target} DISABLE_PRECOMPILE_HEADERS)
    if(NOT own AND NOT reused AND NOT disabled AND NOT pic AND NOT "${libraries}" MATCHES "ARAVIS")
      target_precompile_headers(${target} REUSE_FROM std_headers)
    endif()
  endforeach()
  get_property(folders DIRECTORY ${FOLDER} PROPERTY SUBDIRECTORIES)
  foreach(folder ${folders})
    kagami_precompile_below(${folder})
  endforeach()
endfunction()
