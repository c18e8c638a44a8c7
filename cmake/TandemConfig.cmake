# For plug-ins built outside of this checkout:
#   find_package(Tandem REQUIRED)                       # cmake -DTandem_DIR=<checkout>/cmake
#   tandem_controller(NAME seek_light SOURCES seek_light.cpp)
get_filename_component(Tandem_TOP "${CMAKE_CURRENT_LIST_DIR}/.." ABSOLUTE)

if(NOT CMAKE_BUILD_TYPE AND NOT CMAKE_CONFIGURATION_TYPES)
  set(CMAKE_BUILD_TYPE Release CACHE STRING "" FORCE)
endif()

# The control interface, compiled with the plug-in: the same arithmetic as in Tandem itself, and nothing of any world.
if(NOT TARGET Tandem::hal)
  find_package(Eigen3 REQUIRED NO_MODULE)
  file(GLOB Tandem_HAL_SOURCES "${Tandem_TOP}/hal/*.cpp")
  add_library(tandem_hal STATIC ${Tandem_HAL_SOURCES})
  set_target_properties(tandem_hal PROPERTIES POSITION_INDEPENDENT_CODE ON)
  target_compile_features(tandem_hal PUBLIC cxx_std_20)
  target_compile_options(tandem_hal PUBLIC -ffp-contract=off -fno-math-errno)
  target_compile_definitions(tandem_hal PUBLIC EIGEN_DONT_VECTORIZE)
  target_include_directories(tandem_hal PUBLIC "${Tandem_TOP}")
  target_link_libraries(tandem_hal PUBLIC Eigen3::Eigen)
  add_library(Tandem::hal ALIAS tandem_hal)
endif()

# tandem_controller(NAME x SOURCES x.cpp …): the shared object libx.so in the build folder, for library="…/libx".
function(tandem_controller)
  cmake_parse_arguments(arg "" "NAME" "SOURCES" ${ARGN})
  add_library(${arg_NAME} MODULE ${arg_SOURCES})
  set_target_properties(${arg_NAME} PROPERTIES PREFIX "lib" CXX_VISIBILITY_PRESET hidden
    LIBRARY_OUTPUT_DIRECTORY "${CMAKE_BINARY_DIR}")
  target_compile_options(${arg_NAME} PRIVATE -Wall -Wextra)
  target_link_libraries(${arg_NAME} PRIVATE Tandem::hal)
endfunction()
