#include "core/physics/dynamics3d/ode.hpp"

#include <algorithm>
#include <array>
#include <cstdarg>
#include <cstdio>
#include <cstring>

namespace tandem::core {
namespace {

[[noreturn]] void give_up(int number, const char* message, va_list arguments) {
  std::array<char, 300> text{};
  std::vsnprintf(text.data(), text.size(), message, arguments);
  throw OdeError("error " + std::to_string(number) + " of ODE: " + text.data());
}

/// Process-wide, as ODE's own state is.
class Library {
 public:
  Library() {
    dSetAllocHandler([](dsizeint bytes) { return WorldMemory::allocate_in_use(bytes); });
    dSetReallocHandler([](void* block, dsizeint bytes, dsizeint wanted) {
      void* larger = WorldMemory::allocate_in_use(wanted);
      if (block != nullptr) std::memcpy(larger, block, std::min(bytes, wanted));
      WorldMemory::free_in_use(block);
      return larger;
    });
    dSetFreeHandler([](void* block, dsizeint) { WorldMemory::free_in_use(block); });
    dInitODE2(0);
    dSetErrorHandler([](int number, const char* message, va_list arguments) { give_up(number, message, arguments); });
    dSetDebugHandler([](int number, const char* message, va_list arguments) { give_up(number, message, arguments); });
    dSetMessageHandler([](int, const char*, va_list) {});
  }
  Library(const Library&) = delete;
  Library& operator=(const Library&) = delete;
  ~Library() { dCloseODE(); }
};

thread_local bool ready = false;
thread_local std::uint64_t shuffle = 0;

}  // namespace

void use_ode() {
  if (ready) return;
  static const Library library;
  if (dAllocateODEDataForThread(static_cast<unsigned>(dAllocateMaskAll)) == 0)
    throw OdeError("ODE has no memory for this thread");
  ready = true;
}

void seed_ode(std::uint64_t seed) noexcept {
  shuffle = seed;
}

}  // namespace tandem::core

// ODE calls this through the dynamic linker, which takes a program's own definition first. The step is Knuth's.
int dRandInt(int count) {
  using tandem::core::shuffle;
  shuffle = shuffle * 6364136223846793005ULL + 1442695040888963407ULL;
  return static_cast<int>(((shuffle >> 32) * static_cast<std::uint64_t>(count)) >> 32);
}
