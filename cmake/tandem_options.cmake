# Flags that every target has. -ffp-contract=off and no -march: the same bits on every machine.
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
set(TANDEM_SANITIZE "" CACHE STRING "Sanitizers: address,undefined or thread")

# A program is for its whole architecture, and its arithmetic is IEEE's: flags of one's own that break this are refused.
foreach(flags "${CMAKE_C_FLAGS}" "${CMAKE_CXX_FLAGS}")
  if(flags MATCHES "(-m(arch|cpu|tune)=native|-ffast-math|-Ofast|-funsafe-math-optimizations|-ffp-contract=(fast|on))")
    message(FATAL_ERROR "The compiler flag ${CMAKE_MATCH_1} would make results depend on the machine that builds or runs; leave it "
      "out of CMAKE_C_FLAGS, CMAKE_CXX_FLAGS, CFLAGS and CXXFLAGS")
  endif()
endforeach()

add_library(tandem_flags INTERFACE)
target_compile_options(tandem_flags INTERFACE
  -Wall -Wextra -Wpedantic -Wconversion -Wshadow -ffp-contract=off -fno-math-errno -fvisibility-inlines-hidden)
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
  target_compile_options(tandem_flags INTERFACE -Wno-restrict -Wno-maybe-uninitialized) # false alarms of GCC 12 on std::string
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
    set(CMAKE_${language}_COMPILER_LAUNCHER ${CMAKE_COMMAND} -E env CCACHE_BASEDIR=${PROJECT_SOURCE_DIR} CCACHE_NOHASHDIR=1
      CCACHE_SLOPPINESS=pch_defines,time_macros ${TANDEM_CCACHE})
  endforeach()
endif()
