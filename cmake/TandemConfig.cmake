# For plug-ins built outside of this checkout, or against an installed tree:
#   find_package(Tandem REQUIRED)                       # cmake -DTandem_DIR=<checkout>/cmake, or <prefix>/lib/cmake/Tandem
#   tandem_plugin(NAME greenhouse SOURCES greenhouse.cpp)      devices, fields, engines, bridges, …: any surface
#   tandem_controller(NAME seek_light SOURCES seek_light.cpp)  controllers and hooks
#   find_package(Tandem REQUIRED COMPONENTS core)       # for programs of one's own that hold worlds: <library/open_world.hpp>
#   target_link_libraries(lab PRIVATE Tandem::core)     # of a checkout: that of its release build
# Tandem_PROGRAM is the program, for tests.
get_filename_component(Tandem_TOP "${CMAKE_CURRENT_LIST_DIR}/.." ABSOLUTE)
if(EXISTS "${Tandem_TOP}/hal/plugin.hpp") # a checkout
  set(Tandem_INCLUDE_DIR "${Tandem_TOP}")
  set(Tandem_PROGRAM "${Tandem_TOP}/tandem" CACHE FILEPATH "The program that loads the plug-ins")
else()
  get_filename_component(Tandem_TOP "${CMAKE_CURRENT_LIST_DIR}/../../.." ABSOLUTE)
  set(Tandem_INCLUDE_DIR "${Tandem_TOP}/include/tandem")
  set(Tandem_PROGRAM "${Tandem_TOP}/bin/tandem" CACHE FILEPATH "The program that loads the plug-ins")
endif()

if(NOT CMAKE_BUILD_TYPE AND NOT CMAKE_CONFIGURATION_TYPES)
  set(CMAKE_BUILD_TYPE Release CACHE STRING "" FORCE)
endif()

# The headers of all surfaces, and the flags that make a plug-in's arithmetic and layouts those of the program.
if(NOT TARGET Tandem::headers)
  find_package(Eigen3 REQUIRED NO_MODULE)
  add_library(Tandem::headers INTERFACE IMPORTED)
  set_target_properties(Tandem::headers PROPERTIES
    INTERFACE_INCLUDE_DIRECTORIES "${Tandem_INCLUDE_DIR}"
    INTERFACE_COMPILE_FEATURES cxx_std_20
    INTERFACE_COMPILE_OPTIONS "-ffp-contract=off;-fno-math-errno"
    INTERFACE_COMPILE_DEFINITIONS EIGEN_DONT_VECTORIZE
    INTERFACE_LINK_LIBRARIES Eigen3::Eigen)
endif()

# The control interface, for controllers: the same arithmetic as in Tandem itself, and nothing of any world. It is linked as it was
# built: of a checkout that is what the launcher makes, when there is none yet or a source of it is newer. For other machines,
# whose compiler the project names, it is compiled.
if(NOT TARGET Tandem::hal AND CMAKE_CROSSCOMPILING AND EXISTS "${Tandem_INCLUDE_DIR}/hal/catalog.cpp")
  file(GLOB Tandem_HAL_SOURCES "${Tandem_INCLUDE_DIR}/hal/*.cpp")
  add_library(tandem_hal STATIC EXCLUDE_FROM_ALL ${Tandem_HAL_SOURCES})
  set_target_properties(tandem_hal PROPERTIES POSITION_INDEPENDENT_CODE ON)
  target_link_libraries(tandem_hal PUBLIC Tandem::headers)
  add_library(Tandem::hal ALIAS tandem_hal)
elseif(NOT TARGET Tandem::hal)
  add_library(Tandem::hal STATIC IMPORTED)
  if(EXISTS "${Tandem_INCLUDE_DIR}/hal/catalog.cpp")
    set(hal "${Tandem_TOP}/build/release/hal/libtandem_hal.a")
    if(NOT TARGET tandem_hal_built)
      file(GLOB sources CONFIGURE_DEPENDS "${Tandem_TOP}/hal/*.?pp" "${Tandem_TOP}/hal/device/*.?pp" "${Tandem_TOP}/hal/robot/*.?pp")
      set(built "${CMAKE_BINARY_DIR}/CMakeFiles/tandem_hal.stamp")
      add_custom_command(OUTPUT "${built}" BYPRODUCTS "${hal}" DEPENDS ${sources} VERBATIM COMMENT "Looking for the control interface of ${Tandem_TOP}"
        COMMAND sh -c "test -e \"$1\" && test -z \"$(find \"$0/hal\" -name '*.?pp' -newer \"$1\")\" || exec \"$0/tandem\" build tandem_hal"
          "${Tandem_TOP}" "${hal}"
        COMMAND ${CMAKE_COMMAND} -E touch "${built}")
      add_custom_target(tandem_hal_built DEPENDS "${built}")
    endif()
    add_dependencies(Tandem::hal tandem_hal_built)
  else()
    set(hal "${Tandem_TOP}/lib/tandem/libtandem_hal.a")
  endif()
  set_target_properties(Tandem::hal PROPERTIES IMPORTED_LOCATION "${hal}" INTERFACE_LINK_LIBRARIES "Tandem::headers;${CMAKE_DL_LIBS}")
endif()

# The shared object lib<name>.so in the build folder, for <plugins library="…/lib<name>"/> or library="…/lib<name>".
function(tandem_shared_object name)
  add_library(${name} MODULE ${ARGN})
  set_target_properties(${name} PROPERTIES PREFIX "lib" CXX_VISIBILITY_PRESET hidden
    LIBRARY_OUTPUT_DIRECTORY "${CMAKE_BINARY_DIR}")
  target_compile_options(${name} PRIVATE -Wall -Wextra)
endfunction()

# tandem_controller(NAME x SOURCES x.cpp …): controllers and hooks. Holds the control interface itself, so that it can also be loaded by
# programs of one's own, such as unit tests.
function(tandem_controller)
  cmake_parse_arguments(arg "" "NAME" "SOURCES" ${ARGN})
  tandem_shared_object(${arg_NAME} ${arg_SOURCES})
  target_link_libraries(${arg_NAME} PRIVATE Tandem::hal)
  target_link_options(${arg_NAME} PRIVATE LINKER:--exclude-libs,libtandem_hal.a) # it shows nothing of the interface that it holds
endfunction()

# tandem_plugin(NAME x SOURCES x.cpp …): parts of any kind. What they call of Tandem is the program's own and is found when it
# loads them; so only the sources are compiled, and nothing of the program exists twice.
function(tandem_plugin)
  cmake_parse_arguments(arg "" "NAME" "SOURCES" ${ARGN})
  tandem_shared_object(${arg_NAME} ${arg_SOURCES})
  target_link_libraries(${arg_NAME} PRIVATE Tandem::headers)
endfunction()

# Worlds for programs of one's own.
if("core" IN_LIST Tandem_FIND_COMPONENTS)
  find_library(Tandem_LIBRARY tandem NO_DEFAULT_PATH
    PATHS "${Tandem_TOP}/lib" "${Tandem_TOP}/build/release" PATH_SUFFIXES "${CMAKE_LIBRARY_ARCHITECTURE}")
  set(Tandem_core_FOUND FALSE)
  if(NOT Tandem_LIBRARY)
    set(Tandem_FOUND FALSE)
    set(Tandem_NOT_FOUND_MESSAGE "There is no libtandem.so: in a checkout, `./tandem build` makes it")
  else()
    set(Tandem_core_FOUND TRUE)
    if(NOT TARGET Tandem::core)
      add_library(Tandem::core SHARED IMPORTED)
      set_target_properties(Tandem::core PROPERTIES
        IMPORTED_LOCATION "${Tandem_LIBRARY}"
        INTERFACE_LINK_LIBRARIES Tandem::headers)
    endif()
  endif()
endif()
foreach(component ${Tandem_FIND_COMPONENTS})
  if(Tandem_FIND_REQUIRED_${component} AND NOT component STREQUAL "core" AND NOT component STREQUAL "hal")
    set(Tandem_FOUND FALSE)
    set(Tandem_NOT_FOUND_MESSAGE "There is no component '${component}'; there are: core, hal")
  endif()
endforeach()
