# What the toolchains for boards have in common: Debian's cross compiler, a sysroot made by scripts/sysroot, and qemu, under
# which the tests run. Set before: TANDEM_ARCH, TANDEM_MACHINE, TANDEM_EMULATOR.
set(CMAKE_SYSTEM_NAME Linux)
include(${CMAKE_CURRENT_LIST_DIR}/refuse.cmake)

get_filename_component(top ${CMAKE_CURRENT_LIST_DIR}/../.. ABSOLUTE)
if(NOT TANDEM_SYSROOT)
  set(TANDEM_SYSROOT ${top}/build/sysroot/${TANDEM_ARCH})
endif()
list(APPEND CMAKE_TRY_COMPILE_PLATFORM_VARIABLES TANDEM_SYSROOT) # the compiler's own tests read this file, too
if(NOT CMAKE_C_COMPILER)
  set(CMAKE_C_COMPILER ${TANDEM_MACHINE}-gcc)
endif()
if(NOT CMAKE_CXX_COMPILER)
  set(CMAKE_CXX_COMPILER ${TANDEM_MACHINE}-g++)
endif()
set(CMAKE_SYSROOT ${TANDEM_SYSROOT})
set(CMAKE_LIBRARY_ARCHITECTURE ${TANDEM_MACHINE})

get_property(in_try_compile GLOBAL PROPERTY IN_TRY_COMPILE)
if(NOT in_try_compile)
  tandem_refuse_sysroot(${TANDEM_SYSROOT} ${TANDEM_ARCH} ${TANDEM_MACHINE})
  foreach(compiler ${CMAKE_C_COMPILER} ${CMAKE_CXX_COMPILER})
    tandem_refuse_compiler("${compiler}" "${CMAKE_CXX_FLAGS} $ENV{CXXFLAGS}" ${TANDEM_ARCH} ${TANDEM_MACHINE})
  endforeach()
endif()

set(CMAKE_FIND_ROOT_PATH_MODE_PROGRAM NEVER)
set(CMAKE_FIND_ROOT_PATH_MODE_LIBRARY ONLY)
set(CMAKE_FIND_ROOT_PATH_MODE_INCLUDE ONLY)
set(CMAKE_FIND_ROOT_PATH_MODE_PACKAGE ONLY)
set(ENV{PKG_CONFIG_SYSROOT_DIR} ${CMAKE_SYSROOT})
set(ENV{PKG_CONFIG_LIBDIR} ${CMAKE_SYSROOT}/usr/lib/${TANDEM_MACHINE}/pkgconfig:${CMAKE_SYSROOT}/usr/share/pkgconfig)

set(CMAKE_CROSSCOMPILING_EMULATOR ${TANDEM_EMULATOR} -L ${CMAKE_SYSROOT})
