# Refuses compilers and sysroots whose programs would not run on a board of the architecture that was asked for.
#
# Debian's "armhf" (arm-linux-gnueabihf) means ARMv7 with VFPv3, in the C library's own code already: on an ARM9 or ARM11 its
# programs die with SIGILL, whatever -march is given. "armel" (arm-linux-gnueabi) means ARMv5TE and runs on all of them.

# tandem_refuse_compiler(<compiler> <flags> <architecture> <machine>)
function(tandem_refuse_compiler compiler flags arch machine)
  separate_arguments(flags UNIX_COMMAND "${flags}")
  execute_process(COMMAND ${compiler} ${flags} -dM -E -x c /dev/null OUTPUT_VARIABLE macros ERROR_VARIABLE trouble RESULT_VARIABLE failed)
  if(failed)
    message(FATAL_ERROR "The compiler '${compiler}' for ${arch} does not run: ${failed} ${trouble}\n"
      "./tandem build --preset ${arch} installs it; without the launcher: apt-get install g++-${machine}")
  endif()
  if(arch STREQUAL "arm64")
    if(NOT macros MATCHES "#define __aarch64__ ")
      message(FATAL_ERROR "The compiler '${compiler}' is not one for arm64; use ${machine}-g++")
    endif()
    return()
  endif()
  if(NOT macros MATCHES "#define __arm__ ")
    message(FATAL_ERROR "The compiler '${compiler}' is not one for ${arch}; use ${machine}-g++")
  endif()
  if(macros MATCHES "#define __ARM_PCS_VFP ")
    message(FATAL_ERROR "The compiler '${compiler}' passes floating-point numbers in registers (armhf). Debian's armhf means ARMv7: on "
      "an ARM9 or ARM11 its programs die with SIGILL, and armel's libraries cannot be called. Use ${machine}-g++, without -mfloat-abi=hard")
  endif()
  string(REGEX MATCH "#define __ARM_ARCH ([0-9]+)" ignored "${macros}")
  if(CMAKE_MATCH_1 GREATER 6)
    message(FATAL_ERROR "The compiler '${compiler}' with the flags '${flags}' makes code for ARMv${CMAKE_MATCH_1}; on an ARM9 or ARM11 "
      "it dies with SIGILL. Leave out -march and -mcpu, or name at most -march=armv6")
  endif()
endfunction()

# tandem_refuse_sysroot(<folder> <architecture> <machine>)
function(tandem_refuse_sysroot folder arch machine)
  foreach(other arm-linux-gnueabihf arm-linux-gnueabi aarch64-linux-gnu x86_64-linux-gnu)
    if(NOT other STREQUAL machine AND EXISTS ${folder}/usr/lib/${other})
      if(arch STREQUAL "armel" AND other STREQUAL "arm-linux-gnueabihf")
        set(why ": Debian's armhf libraries are ARMv7 code, on which an ARM9 or ARM11 dies with SIGILL")
      endif()
      message(FATAL_ERROR "The sysroot ${folder} holds libraries for ${other}, not for ${arch}${why}. Make another: scripts/sysroot "
        "${arch} ${folder}")
    endif()
  endforeach()
  if(NOT EXISTS ${folder}/usr/lib/${machine})
    message(FATAL_ERROR "There is no sysroot for ${arch} in ${folder}; make it: scripts/sysroot ${arch}")
  endif()
endfunction()
