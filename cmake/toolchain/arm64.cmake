# Boards with a 64-bit ARM.
set(TANDEM_ARCH arm64)
set(TANDEM_MACHINE aarch64-linux-gnu)
set(TANDEM_EMULATOR qemu-aarch64)
set(CMAKE_SYSTEM_PROCESSOR aarch64)
include(${CMAKE_CURRENT_LIST_DIR}/board.cmake)
