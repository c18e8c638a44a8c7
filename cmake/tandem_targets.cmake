# The three kinds of target. What a folder may include is written once, in DEPS; tests/architecture reads the same lists.
include(GNUInstallDirs)
set_property(GLOBAL PROPERTY TANDEM_ARCHITECTURE "")

# tandem_folder_of(<out>): the folder of the calling CMakeLists, relative to the top, e.g. "core/space".
function(tandem_folder_of out)
  file(RELATIVE_PATH folder ${PROJECT_SOURCE_DIR} ${CMAKE_CURRENT_SOURCE_DIR})
  set(${out} ${folder} PARENT_SCOPE)
endfunction()

# tandem_target_of(<out> <folder>): "core/space" -> "tandem_core_space".
function(tandem_target_of out folder)
  string(REPLACE "/" "_" name ${folder})
  set(${out} tandem_${name} PARENT_SCOPE)
endfunction()

function(tandem_note folder deps external)
  string(REPLACE ";" " " deps "${deps}")
  string(REPLACE ";" " " external "${external}")
  set_property(GLOBAL APPEND PROPERTY TANDEM_ARCHITECTURE "${folder} : ${deps} : ${external}")
endfunction()

# tandem_compile_together(<target> APART a.cpp …): its sources are compiled eight at once, which saves most of the time for headers;
# those of APART one by one, because they have helpers of the same names as others. On boards each is by itself, so that a missing
# include is noticed.
function(tandem_compile_together target)
  cmake_parse_arguments(arg "" "" "APART" ${ARGN})
  if(TANDEM_BOARD)
    return()
  endif()
  set_target_properties(${target} PROPERTIES UNITY_BUILD ON)
  set_property(SOURCE ${arg_APART} PROPERTY SKIP_UNITY_BUILD_INCLUSION ON)
  if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
    target_compile_options(${target} PRIVATE -Wno-subobject-linkage) # of a class within a source that another one includes
  endif()
endfunction()

# tandem_library(SOURCES a.cpp … DEPS hal core/space … EXTERNAL fmt::fmt … INCLUDES fmt …)
# One folder = one static library. DEPS are folders, and the only ones whose headers may be included.
# EXTERNAL are third-party CMake targets or link names. A folder that no tick waits for sets TANDEM_OUTSIDE_THE_TICK for itself
# and those in it, to tandem_quick_build: it is optimised less, and built in two thirds of the time. HEADERS: what most of its
# files include and takes long to parse; parsed once for the folder, on top of what all folders share. QUICK: those of a folder of
# the tick that no tick waits for. APART: see tandem_compile_together.
function(tandem_library)
  cmake_parse_arguments(arg "" "" "SOURCES;QUICK;APART;DEPS;EXTERNAL;HEADERS" ${ARGN})
  tandem_folder_of(folder)
  tandem_target_of(target ${folder})
  if(arg_SOURCES)
    add_library(${target} STATIC ${arg_SOURCES} ${arg_APART})
    tandem_compile_together(${target} APART ${arg_APART})
    if(arg_QUICK)
      add_library(${target}_quick OBJECT ${arg_QUICK})
      tandem_compile_together(${target}_quick)
      target_link_libraries(${target}_quick PRIVATE tandem_flags $<TARGET_PROPERTY:${target},INTERFACE_LINK_LIBRARIES>)
      target_include_directories(${target}_quick PRIVATE ${PROJECT_SOURCE_DIR})
      target_compile_definitions(${target}_quick PRIVATE $<TARGET_PROPERTY:${target},INTERFACE_COMPILE_DEFINITIONS>)
      target_compile_options(${target}_quick PRIVATE ${tandem_quick_build})
      target_precompile_headers(${target}_quick REUSE_FROM tandem_headers)
      target_sources(${target} PRIVATE $<TARGET_OBJECTS:${target}_quick>)
    endif()
    set(scope PUBLIC)
    target_link_libraries(${target} PRIVATE tandem_flags)
    target_compile_options(${target} PRIVATE ${TANDEM_OUTSIDE_THE_TICK})
    if(arg_HEADERS)
      target_precompile_headers(${target} PRIVATE ${tandem_shared_headers} ${arg_HEADERS})
      tandem_describe_pch(${target} ${tandem_shared_headers} ${arg_HEADERS})
    else()
      target_precompile_headers(${target} REUSE_FROM tandem_headers)
    endif()
  else()
    add_library(${target} INTERFACE)
    set(scope INTERFACE)
  endif()
  target_include_directories(${target} ${scope} ${PROJECT_SOURCE_DIR})
  foreach(dep ${arg_DEPS})
    tandem_target_of(dep_target ${dep})
    target_link_libraries(${target} ${scope} ${dep_target})
  endforeach()
  target_link_libraries(${target} ${scope} ${arg_EXTERNAL})
  tandem_note("${folder}" "${arg_DEPS}" "${arg_EXTERNAL}")
endfunction()

# tandem_noted(<out> <folder> DEPS|EXTERNAL): what the folder has declared.
function(tandem_noted out folder which)
  set(${out} "" PARENT_SCOPE)
  get_property(lines GLOBAL PROPERTY TANDEM_ARCHITECTURE)
  foreach(line ${lines})
    if(line MATCHES "^${folder} : ([^:]*) : (.*)$")
      set(noted "${CMAKE_MATCH_1}")
      if(which STREQUAL "EXTERNAL")
        set(noted "${CMAKE_MATCH_2}")
      endif()
      string(REPLACE " " ";" noted "${noted}")
      set(${out} ${noted} PARENT_SCOPE)
    endif()
  endforeach()
endfunction()

# tandem_closure(<out> <folder>…): these folders and all that they depend on, as far as they were added.
function(tandem_closure out)
  set(open ${ARGN})
  set(found)
  while(open)
    list(POP_FRONT open folder)
    if(NOT folder IN_LIST found)
      list(APPEND found ${folder})
      tandem_noted(deps ${folder} DEPS)
      list(APPEND open ${deps})
    endif()
  endwhile()
  set(${out} ${found} PARENT_SCOPE)
endfunction()

# tandem_built_targets(<out> <folder>…): their targets, but for those that have headers alone.
function(tandem_built_targets out)
  set(targets)
  foreach(folder ${ARGN})
    tandem_target_of(target ${folder})
    if(TARGET ${target})
      get_target_property(type ${target} TYPE)
      if(type STREQUAL "STATIC_LIBRARY")
        list(APPEND targets ${target})
      endif()
    endif()
  endforeach()
  set(${out} ${targets} PARENT_SCOPE)
endfunction()

# tandem_module(real NEEDS live): a library of its own, lib/modules/libtandem_real.so, of app/real and all that it
# depends on and that neither the program nor the modules that it NEEDS have.
function(tandem_module name)
  cmake_parse_arguments(arg "" "" "NEEDS" ${ARGN})
  set(others app)
  foreach(other ${arg_NEEDS})
    list(APPEND others app/${other})
  endforeach()
  tandem_closure(there ${others})
  set(own app/${name})
  if(name STREQUAL "lab")
    set(own lab) # it has commands of folders above app
  endif()
  tandem_closure(folders ${own})
  list(REMOVE_ITEM folders ${there})
  tandem_built_targets(targets ${folders})
  set(external)
  foreach(folder ${folders})
    tandem_noted(of_folder ${folder} EXTERNAL)
    list(APPEND external ${of_folder})
  endforeach()
  list(REMOVE_DUPLICATES external)
  set(source ${CMAKE_BINARY_DIR}/modules/${name}.cpp)
  file(CONFIGURE OUTPUT ${source} CONTENT "#include \"${own}/register.hpp\"\n#include \"hal/plugin.hpp\"\nTANDEM_PLUGIN(tandem::app::register_${name})\n")
  set(target tandem_module_${name})
  add_library(${target} SHARED ${source})
  target_include_directories(${target} PRIVATE ${PROJECT_SOURCE_DIR} $<TARGET_PROPERTY:tandem_hal,INTERFACE_INCLUDE_DIRECTORIES>)
  target_compile_options(${target} PRIVATE ${tandem_quick_build})
  set_target_properties(${target} PROPERTIES OUTPUT_NAME tandem_${name} LIBRARY_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/lib/modules
    BUILD_WITH_INSTALL_RPATH ON INSTALL_RPATH "$ORIGIN")
  set(archives)
  foreach(archive ${targets})
    list(APPEND archives $<TARGET_FILE:${archive}>)
    add_dependencies(${target} ${archive})
  endforeach()
  foreach(other ${arg_NEEDS})
    list(APPEND archives tandem_module_${other})
  endforeach()
  target_link_libraries(${target} PRIVATE tandem_flags -Wl,--whole-archive ${archives} -Wl,--no-whole-archive ${external})
  set_property(TARGET ${target} APPEND PROPERTY LINK_DEPENDS ${archives})
  set_property(GLOBAL APPEND PROPERTY TANDEM_MODULES ${target})
endfunction()

# tandem_carry(<out.cpp> <tandem::folder::function> FROM <folder> FILES …): writes a source with a function that returns these files,
# a span of hal::CarriedFile, by their names in the folder. The function is declared by whoever calls it.
function(tandem_carry out function)
  cmake_parse_arguments(arg "" "FROM" "FILES" ${ARGN})
  set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${arg_FILES})
  list(LENGTH arg_FILES count)
  string(REGEX REPLACE "::[a-z_]+$" "" space ${function})
  string(REGEX REPLACE "^.*::" "" name ${function})
  set(text "// Written by CMake: files that the program carries.\n#include <array>\n\n#include \"hal/carried_file.hpp\"\n\nnamespace ${space} {\n\n")
  string(APPEND text "std::span<const hal::CarriedFile> ${name}() {\n  static constexpr std::array<hal::CarriedFile, ${count}> kAll = {{\n")
  foreach(file ${arg_FILES})
    file(READ ${file} content)
    file(RELATIVE_PATH name ${arg_FROM} ${file})
    string(APPEND text "{\"${name}\", R\"tandem(${content})tandem\"},\n")
  endforeach()
  string(APPEND text "}};\n  return kAll;\n}\n\n}  // namespace ${space}\n")
  file(CONFIGURE OUTPUT ${out} CONTENT "${text}" @ONLY)
endfunction()

# tandem_plugin(NAME epuck_diffusion SOURCES … DEPS hal): one shared object, lib/<name>.so in the build folder.
function(tandem_plugin)
  cmake_parse_arguments(arg "" "NAME" "SOURCES;APART;DEPS;EXTERNAL" ${ARGN})
  tandem_folder_of(folder)
  add_library(${arg_NAME} MODULE ${arg_SOURCES} ${arg_APART})
  tandem_compile_together(${arg_NAME} APART ${arg_APART})
  target_include_directories(${arg_NAME} PRIVATE ${PROJECT_SOURCE_DIR})
  set_target_properties(${arg_NAME} PROPERTIES PREFIX "lib" CXX_VISIBILITY_PRESET hidden
    LIBRARY_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/lib)
  target_link_libraries(${arg_NAME} PRIVATE tandem_flags)
  if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU") # clang wants the same visibility in both
    target_precompile_headers(${arg_NAME} REUSE_FROM tandem_headers)
  endif()
  foreach(dep ${arg_DEPS})
    tandem_target_of(dep_target ${dep})
    target_link_libraries(${arg_NAME} PRIVATE ${dep_target})
  endforeach()
  target_link_libraries(${arg_NAME} PRIVATE ${arg_EXTERNAL})
  tandem_note("${folder}" "${arg_DEPS}" "${arg_EXTERNAL}")
  set_property(GLOBAL APPEND PROPERTY TANDEM_PLUGINS ${arg_NAME})
  string(REGEX MATCH "^[^/]+" layer ${folder})
  set_property(GLOBAL APPEND PROPERTY TANDEM_PLUGINS_OF_${layer} ${arg_NAME})
endfunction()

# tandem_test_program(NAME x SOURCES … DEPS … EXTERNAL …): the GoogleTest program test_<x>, without a ctest entry.
# All share one precompiled header, and none has more optimisation or instrumentation than a test needs (tandem_test_flags). Its sources
# are compiled together, which saves most of the time for headers; APART: one by one, because some have helpers of the same names.
function(tandem_test_program)
  cmake_parse_arguments(arg "APART" "NAME" "SOURCES;DEPS;EXTERNAL" ${ARGN})
  if(NOT TARGET tandem_test_headers)
    file(CONFIGURE OUTPUT ${CMAKE_BINARY_DIR}/test_headers.cpp CONTENT "int main() {}\n") # carries it; an executable, as they are
    add_executable(tandem_test_headers ${CMAKE_BINARY_DIR}/test_headers.cpp)
    target_link_libraries(tandem_test_headers PRIVATE tandem_flags tandem_test_flags GTest::gtest GTest::gmock)
    set(headers <algorithm> <array> <atomic> <chrono> <cmath> <filesystem> <fstream> <functional> <map> <memory> <optional> <span> <sstream>
      <string> <thread> <vector> <gmock/gmock.h> <gtest/gtest.h>)
    target_precompile_headers(tandem_test_headers PRIVATE ${headers})
    tandem_describe_pch(tandem_test_headers ${headers})
  endif()
  add_executable(test_${arg_NAME} ${arg_SOURCES})
  target_link_libraries(test_${arg_NAME} PRIVATE
    tandem_flags tandem_test_flags tandem_checkout GTest::gtest GTest::gtest_main GTest::gmock ${arg_EXTERNAL})
  foreach(dep ${arg_DEPS})
    tandem_target_of(dep_target ${dep})
    target_link_libraries(test_${arg_NAME} PRIVATE ${dep_target})
  endforeach()
  target_precompile_headers(test_${arg_NAME} REUSE_FROM tandem_test_headers)
  if(NOT arg_APART)
    tandem_compile_together(test_${arg_NAME})
  endif()
  set_target_properties(test_${arg_NAME} PROPERTIES RUNTIME_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/tests)
endfunction()

# tandem_label_test(<ctest entry> <program's target> LABELS …): what chooses tests. For each label the target tests_<label> builds them.
#   fast       runs side by side with others        whole     uses real processes and real time
#   threads    has threads at stake: what the thread sanitizer is for
#   behaviour  of controllers, by results: nothing for sanitizers        memory   fast, but behaviour: for the address sanitizer
#   board      what a robot's board needs, on an emulated processor
function(tandem_label_test entry target)
  set(labels ${ARGN})
  if("fast" IN_LIST labels AND NOT "behaviour" IN_LIST labels)
    list(APPEND labels memory)
  endif()
  if(TANDEM_BOARD AND NOT entry MATCHES "emulator|^core_")
    list(APPEND labels board)
  endif()
  set_property(TEST ${entry} PROPERTY LABELS "${labels}")
  foreach(label ${labels})
    if(NOT TARGET tests_${label})
      add_custom_target(tests_${label})
    endif()
    add_dependencies(tests_${label} ${target})
  endforeach()
endfunction()

# tandem_test(NAME hal_params SOURCES … DEPS hal LABELS fast): one GoogleTest program, one ctest entry.
# WAITS: it mostly waits for real time to pass (label `waits`): many run side by side, but beside none that computes. Each test has
# fair trials (tests/scenarios/fair_trials.cpp), as many as that may need. FAIR: those alone, of one that computes much itself.
# COUNTED: GoogleTest's pattern of those that repeat much to judge by counts; checked programs leave them out. APART, as for tandem_test_program.
function(tandem_test)
  cmake_parse_arguments(arg "WAITS;FAIR" "NAME;TIMEOUT;COUNTED" "SOURCES;DEPS;EXTERNAL;LABELS" ${ARGN})
  if(NOT arg_TIMEOUT)
    set(arg_TIMEOUT 120)
  endif()
  if(arg_WAITS)
    set(arg_FAIR ON)
    list(APPEND arg_LABELS waits)
  endif()
  if(arg_FAIR)
    math(EXPR arg_TIMEOUT "${arg_TIMEOUT} * 3")
    list(APPEND arg_SOURCES ${PROJECT_SOURCE_DIR}/tests/scenarios/fair_trials.cpp)
    list(APPEND arg_DEPS hal)
    list(REMOVE_DUPLICATES arg_DEPS)
  endif()
  if(CMAKE_CROSSCOMPILING)
    math(EXPR arg_TIMEOUT "${arg_TIMEOUT} * 10") # an emulated processor is slow
  elseif(TANDEM_SANITIZE)
    math(EXPR arg_TIMEOUT "${arg_TIMEOUT} * 4") # so are checked programs
  endif()
  tandem_test_program(${arg_UNPARSED_ARGUMENTS} NAME ${arg_NAME} SOURCES ${arg_SOURCES} DEPS ${arg_DEPS} EXTERNAL ${arg_EXTERNAL})
  set(filter)
  if(arg_COUNTED AND TANDEM_SANITIZE)
    set(filter --gtest_filter=-${arg_COUNTED})
  endif()
  add_test(NAME ${arg_NAME} COMMAND test_${arg_NAME} ${filter})
  set_tests_properties(${arg_NAME} PROPERTIES TIMEOUT ${arg_TIMEOUT})
  if("whole" IN_LIST arg_LABELS)
    set_tests_properties(${arg_NAME} PROPERTIES COST ${arg_TIMEOUT}) # long ones are begun first
  endif()
  if(arg_FAIR)
    set_tests_properties(${arg_NAME} PROPERTIES SKIP_RETURN_CODE 77)
  endif()
  tandem_label_test(${arg_NAME} test_${arg_NAME} ${arg_LABELS})
  # Locks of robots in a folder of its own: the system gives the pseudo-terminal of a test's lost robot to another test's. A
  # digest, because sockets have short names, and numbers would change with the list of tests.
  string(MD5 digest ${arg_NAME})
  string(SUBSTRING ${digest} 0 6 digest)
  file(MAKE_DIRECTORY ${CMAKE_BINARY_DIR}/run/${digest})
  set_property(TEST ${arg_NAME} APPEND PROPERTY ENVIRONMENT "XDG_RUNTIME_DIR=${CMAKE_BINARY_DIR}/run/${digest}")
  if(TANDEM_SANITIZE MATCHES "address") # a hook plug-in and its test program both hold core: the program's is used
    set_property(TEST ${arg_NAME} APPEND PROPERTY ENVIRONMENT
      "ASAN_OPTIONS=detect_odr_violation=0" "LSAN_OPTIONS=suppressions=${PROJECT_SOURCE_DIR}/tests/sanitizers/lsan.supp")
  endif()
  if(TANDEM_SANITIZE MATCHES "thread") # libraries that are not built with it keep locks that it does not see
    set_property(TEST ${arg_NAME} APPEND PROPERTY ENVIRONMENT
      "TSAN_OPTIONS=suppressions=${PROJECT_SOURCE_DIR}/tests/bridges/lcm/tsan.supp")
  endif()
endfunction()

# One line a folder, "folder : its DEPS : its third-party libraries", for the architecture test.
function(tandem_write_architecture file)
  get_property(lines GLOBAL PROPERTY TANDEM_ARCHITECTURE)
  string(REPLACE ";" "\n" text "${lines}")
  file(WRITE ${file} "${text}\n")
endfunction()

# tandem_add_folders(a b …): the sub-folders that there are, in the order of their dependencies.
function(tandem_add_folders)
  foreach(folder ${ARGN})
    if(EXISTS ${CMAKE_CURRENT_SOURCE_DIR}/${folder}/CMakeLists.txt)
      add_subdirectory(${folder})
    endif()
  endforeach()
endfunction()
