# Boards with an ARM9 or an ARM11, or anything newer with 32 bits: ARMv5TE and no floating-point unit taken for granted.
set(TANDEM_ARCH armel)
set(TANDEM_MACHINE arm-linux-gnueabi)
set(TANDEM_EMULATOR qemu-arm -cpu arm1136)
set(CMAKE_SYSTEM_PROCESSOR armv5tel)
include(${CMAKE_CURRENT_LIST_DIR}/board.cmake)
