#include "hal/plugin_call.hpp"

#include <charconv>
#include <csignal>
#include <sys/mman.h>

namespace tandem::hal {
namespace {

constexpr std::size_t kSignalStackBytes = std::size_t{64} << 10;

std::array<CallMark, kMostMarks> marks;
std::array<std::atomic<bool>, kMostMarks> taken{};
constinit thread_local CallMark* known = nullptr;

/// A thread's mark and signal stack; both are given back when the thread ends.
class ThreadMark {
 public:
  ThreadMark() noexcept {
    while (number_ + 1 < kMostMarks && taken[number_].exchange(true, std::memory_order_acquire)) ++number_;
    known = &marks[number_];
    stack_t old{};
    if (sigaltstack(nullptr, &old) != 0 || (old.ss_flags & SS_DISABLE) == 0) return;  // somebody else's is there
    void* memory =
        mmap(nullptr, kSignalStackBytes, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS | MAP_STACK, -1, 0);
    if (memory == MAP_FAILED) return;  // then a stack that overflows ends the process without a message
    stack_t stack{};
    stack.ss_sp = memory;
    stack.ss_size = kSignalStackBytes;
    if (sigaltstack(&stack, nullptr) == 0) stack_ = memory;
  }
  /// `known` stays: `exit` ends the thread's objects before it asks who called it.
  ~ThreadMark() {
    if (number_ + 1 < kMostMarks) taken[number_].store(false, std::memory_order_release);
    if (stack_ == nullptr) return;
    stack_t none{};
    none.ss_flags = SS_DISABLE;
    sigaltstack(&none, nullptr);
    munmap(stack_, kSignalStackBytes);
  }
  ThreadMark(const ThreadMark&) = delete;
  ThreadMark& operator=(const ThreadMark&) = delete;

  CallMark& mark() noexcept { return marks[number_]; }

 private:
  std::size_t number_ = 0;
  void* stack_ = nullptr;
};

}  // namespace

FixedText& FixedText::operator<<(std::int64_t number) noexcept {
  char digits[24];
  return *this << std::string_view(digits, std::to_chars(digits, digits + sizeof digits, number).ptr);
}

CallMark& this_thread_mark() noexcept {
  if (known != nullptr) return *known;
  thread_local ThreadMark mine;
  return mine.mark();
}

CallMark* known_thread_mark() noexcept {
  return known;
}

std::array<CallMark, kMostMarks>& call_marks() noexcept {
  return marks;
}

bool name_call(const CallMark& mark, FixedText& out) noexcept {
  const NameCall name = mark.name.load(std::memory_order_acquire);
  if (name == nullptr) return false;
  name(mark.object.load(std::memory_order_relaxed), mark.part.load(std::memory_order_relaxed), mark.index(), out);
  return true;
}

}  // namespace tandem::hal
