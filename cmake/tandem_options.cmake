# Flags that every target has, and which parts of the program are configured. -ffp-contract=off and no -march: the same bits on every machine.
set(CMAKE_CXX_STANDARD 20)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_POSITION_INDEPENDENT_CODE ON)
set(CMAKE_EXPORT_COMPILE_COMMANDS ON)
set(CMAKE_CXX_FLAGS_RELEASE "-O3 -g1")        # assertions are TANDEM_CHECK, which stays in
set(CMAKE_CXX_FLAGS_RELWITHDEBINFO "-O1 -g1") # the sanitizer presets: quick to build, readable traces

option(TANDEM_WERROR "Warnings are errors (for continuous integration)" OFF)
option(TANDEM_BOARD "Only what a robot's board needs: controllers, bridges, `tandem robot`" OFF)
option(TANDEM_FUZZ "Instrument for libFuzzer and build its programs (needs clang)" OFF)
set(TANDEM_PARTS all CACHE STRING "What is configured besides runs of simulated robots: all, or modules, python, hdf5, lua_controller")
set(TANDEM_SANITIZE "" CACHE STRING "Sanitizers: address,undefined or thread")

# A program is for its whole architecture, and its arithmetic is IEEE's: flags of one's own that break this are refused.
foreach(flags "${CMAKE_C_FLAGS}" "${CMAKE_CXX_FLAGS}")
  if(flags MATCHES "(-m(arch|cpu|tune)=native|-ffast-math|-Ofast|-funsafe-math-optimizations|-ffp-contract=(fast|on))")
    message(FATAL_ERROR "The compiler flag ${CMAKE_MATCH_1} would make results depend on the machine that builds or runs; leave it "
      "out of CMAKE_C_FLAGS, CMAKE_CXX_FLAGS, CFLAGS and CXXFLAGS")
  endif()
endforeach()

set(tandem_quick_build $<$<AND:$<CONFIG:Release>,$<NOT:$<BOOL:${TANDEM_BOARD}>>>:-O1>)

add_library(tandem_flags INTERFACE)
target_compile_options(tandem_flags INTERFACE
  -Wall -Wextra -Wpedantic -Wconversion -Wshadow -ffp-contract=off -fno-math-errno -fvisibility-inlines-hidden)
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
  target_compile_options(tandem_flags INTERFACE -Wno-restrict -Wno-maybe-uninitialized -Wno-stringop-overflow -Wno-stringop-overread
    -Wno-array-bounds -Wno-free-nonheap-object) # false alarms of GCC 12 on std::string
endif()
if(CMAKE_SYSTEM_PROCESSOR MATCHES "^arm")
  target_compile_options(tandem_flags INTERFACE -Wno-psabi) # remarks on libraries built with GCC 6: there are none
  target_link_libraries(tandem_flags INTERFACE atomic)      # ARMv5 has no instructions for atomic numbers of 64 bits
endif()
if(TANDEM_WERROR)
  target_compile_options(tandem_flags INTERFACE -Werror)
endif()
if(TANDEM_SANITIZE)
  target_compile_options(tandem_flags INTERFACE -fsanitize=${TANDEM_SANITIZE} -fno-sanitize-recover=all -fno-omit-frame-pointer)
  target_link_options(tandem_flags INTERFACE -fsanitize=${TANDEM_SANITIZE})
endif()
if(TANDEM_FUZZ) # the same objects serve the sanitized tests and the libFuzzer programs
  target_compile_options(tandem_flags INTERFACE -fsanitize=fuzzer-no-link)
endif()

# tandem_describe_pch(<target> <header>…): tells the compiler cache what the target's precompiled header is made of. Two clones
# make different bytes of the same headers, so it is to go by this, beside the file, and not by its bytes.
function(tandem_describe_pch target)
  set(digest "${CMAKE_CXX_COMPILER_ID} ${CMAKE_CXX_COMPILER_VERSION} ${CMAKE_BUILD_TYPE} ${CMAKE_CXX_FLAGS} ${TANDEM_SANITIZE} ${TANDEM_FUZZ}")
  file(GLOB versions /usr/include/gtest/gtest.h /usr/include/c++/*/bits/basic_string.h) # packages may be renewed
  foreach(header ${ARGN} ${versions})
    set(content)
    if(EXISTS ${header})
      file(SHA256 ${header} content)
    endif()
    string(APPEND digest " ${header} ${content}")
  endforeach()
  foreach(suffix gch pch)
    file(CONFIGURE OUTPUT ${CMAKE_CURRENT_BINARY_DIR}/CMakeFiles/${target}.dir/cmake_pch.hxx.${suffix}.sum CONTENT "${digest}\n")
  endforeach()
endfunction()

# The standard library's headers, parsed once for all libraries. Each file still includes what it uses: robots' boards are built
# without (CMAKE_DISABLE_PRECOMPILE_HEADERS), so that a missing include is noticed.
file(CONFIGURE OUTPUT ${CMAKE_BINARY_DIR}/headers.cpp CONTENT "// Carries the precompiled header of all libraries.\n")
add_library(tandem_headers OBJECT ${CMAKE_BINARY_DIR}/headers.cpp)
target_link_libraries(tandem_headers PRIVATE tandem_flags)
set(tandem_shared_headers <algorithm> <array> <atomic> <cmath> <condition_variable> <cstdint> <cstring> <fstream> <functional> <map> <memory> <mutex>
  <numeric> <optional> <span> <sstream> <string> <string_view> <thread> <vector>)
target_precompile_headers(tandem_headers PRIVATE ${tandem_shared_headers})
tandem_describe_pch(tandem_headers ${tandem_shared_headers})

# The tests' own code, on top of tandem_flags: what it calls is what is tested, so it is built for little compile time.
# Under the thread sanitizer it is instrumented as everything is: an atomic that it does not see would be a false alarm.
add_library(tandem_test_flags INTERFACE)
if(TANDEM_SANITIZE MATCHES "address")
  target_compile_options(tandem_test_flags INTERFACE -O0 -fno-sanitize=undefined)
  if(TANDEM_FUZZ)
    target_compile_options(tandem_test_flags INTERFACE -fno-sanitize=fuzzer-no-link)
  endif()
else()
  target_compile_options(tandem_test_flags INTERFACE -O1)
endif()

# A compiler cache, where there is one, serves all clones: neither paths of the checkout nor of the build folder are part of
# what is compiled. Results are the same without it.
add_compile_options(-ffile-prefix-map=${PROJECT_SOURCE_DIR}/=)
find_program(TANDEM_CCACHE ccache)
if(TANDEM_CCACHE)
  foreach(language C CXX)
    set(CMAKE_${language}_COMPILER_LAUNCHER env CCACHE_BASEDIR=${PROJECT_SOURCE_DIR} CCACHE_NOHASHDIR=1
      CCACHE_SLOPPINESS=pch_defines,time_macros CCACHE_PCH_EXTSUM=1 ${TANDEM_CCACHE})
  endforeach()
endif()

# Modules need others (app/module/module_table.hpp says so, too).
set(tandem_parts ${TANDEM_PARTS})
if("lab" IN_LIST tandem_parts)
  list(APPEND tandem_parts real window study)
endif()
if("lab" IN_LIST tandem_parts OR "python" IN_LIST tandem_parts)
  list(APPEND tandem_parts dynamics)
endif()
if("window" IN_LIST tandem_parts)
  list(APPEND tandem_parts pictures)
endif()
if("window" IN_LIST tandem_parts OR "real" IN_LIST tandem_parts)
  list(APPEND tandem_parts live)
endif()
if(TANDEM_BOARD OR TANDEM_SANITIZE)
  set(tandem_parts all)
endif()
# tandem_wants(<part>…): sets `wanted`: whether one of these parts is configured.
function(tandem_wants)
  set(wanted OFF PARENT_SCOPE)
  foreach(part all ${ARGN})
    if(part IN_LIST tandem_parts)
      set(wanted ON PARENT_SCOPE)
    endif()
  endforeach()
endfunction()
# tandem_add_wanted(FOLDERS … FOR <part>…): these sub-folders, where one of the parts is configured.
macro(tandem_add_wanted)
  cmake_parse_arguments(tandem_add "" "" "FOLDERS;FOR" ${ARGN})
  tandem_wants(${tandem_add_FOR})
  if(wanted)
    tandem_add_folders(${tandem_add_FOLDERS})
  endif()
endmacro()
