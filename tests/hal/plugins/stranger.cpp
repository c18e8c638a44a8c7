// Has the plug-in's symbol, but what stands there is something else.
#include <cstdint>

extern "C" __attribute__((visibility("default"))) const std::uint64_t tandem_plugin[8];
const std::uint64_t tandem_plugin[8] = {1, 2, 3, 4, 5, 6, 7, 8};
