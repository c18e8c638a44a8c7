// Marks of calls into plug-ins: whose code a thread is running, for watchdogs and crash handlers.
#pragma once
#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "hal/controller.hpp"

namespace tandem::hal {

/// Text of bounded length that is put together without allocating; what does not fit is left out.
class FixedText {
 public:
  FixedText& operator<<(std::string_view text) noexcept {
    for (const char c : text) {
      if (size_ < text_.size()) text_[size_++] = c;
    }
    return *this;
  }
  FixedText& operator<<(std::int64_t number) noexcept;
  std::string_view view() const noexcept { return {text_.data(), size_}; }

 private:
  std::array<char, 1000> text_;  // not initialised: it is on the stack of signal handlers
  std::size_t size_ = 0;
};

/// Tells what a call is: "controller 'c' (library 'x') of robot 'fb3' in its step at tick 17". Is called from signal
/// handlers and other threads while the call goes on: allocates and locks nothing, and reads only what stays as it is
/// during the call.
using NameCall = void (*)(const void* object, std::size_t part, std::size_t index, FixedText& out) noexcept;

/// Current plug-in call of one thread. Lives as long as the process, so that it can be looked at whenever.
struct alignas(64) CallMark {
  std::atomic<NameCall> name{nullptr};  ///< null: no code of a plug-in
  std::atomic<const void*> object{nullptr};
  std::atomic<std::size_t> part{0};
  std::atomic<std::size_t> calls{0};  ///< that were begun so far
  StepFault fault;                    ///< for `step_row`, which keeps `fault.index` up to date

  std::size_t index() const noexcept { return __atomic_load_n(&fault.index, __ATOMIC_RELAXED); }
  void set_index(std::size_t index) noexcept { __atomic_store_n(&fault.index, index, __ATOMIC_RELAXED); }
};

inline constexpr std::size_t kMostMarks = 1100;  ///< threads beyond share the last one

/// Of this thread. The first call gives the thread a stack of its own for signal handlers.
CallMark& this_thread_mark() noexcept;
/// The same, or null when this thread has none yet: for signal handlers.
CallMark* known_thread_mark() noexcept;
/// All marks, those of threads that do not run any plug-in too.
std::array<CallMark, kMostMarks>& call_marks() noexcept;

/// Marks that this thread runs code of a plug-in, for as long as this lives. Calls nest.
class PluginCall {
 public:
  /// `object` is handed to `name`.
  PluginCall(NameCall name, const void* object, std::size_t part = 0, std::size_t index = 0) noexcept
      : mark_(this_thread_mark()),
        outer_name_(mark_.name.load(std::memory_order_relaxed)),
        outer_object_(mark_.object.load(std::memory_order_relaxed)),
        outer_part_(mark_.part.load(std::memory_order_relaxed)),
        outer_index_(mark_.index()) {
    set(name, object, part, index);
  }
  ~PluginCall() { set(outer_name_, outer_object_, outer_part_, outer_index_); }
  PluginCall(const PluginCall&) = delete;
  PluginCall& operator=(const PluginCall&) = delete;

  /// For `step_row`.
  StepFault& fault() noexcept { return mark_.fault; }

 private:
  void set(NameCall name, const void* object, std::size_t part, std::size_t index) noexcept {
    mark_.name.store(nullptr, std::memory_order_release);  // no mixture of two calls is ever shown
    mark_.calls.store(mark_.calls.load(std::memory_order_relaxed) + 1, std::memory_order_relaxed);
    mark_.object.store(object, std::memory_order_relaxed);
    mark_.part.store(part, std::memory_order_relaxed);
    mark_.set_index(index);
    mark_.name.store(name, std::memory_order_release);
  }

  CallMark& mark_;
  NameCall outer_name_;
  const void* outer_object_;
  std::size_t outer_part_, outer_index_;
};

/// Writes what `mark` is about. @returns false when it is no code of a plug-in.
bool name_call(const CallMark& mark, FixedText& out) noexcept;

}  // namespace tandem::hal
