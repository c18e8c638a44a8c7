#include "app/process/emergency.hpp"

#include <array>
#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <dlfcn.h>
#include <exception>
#include <execinfo.h>
#include <new>
#include <string>
#include <sys/syscall.h>
#include <unistd.h>

#include "app/exit_code.hpp"
#include "app/process/terminal.hpp"
#include "hal/plugin_call.hpp"
#include "hal/printable.hpp"

namespace tandem::app {
namespace {

std::atomic<const EmergencySaver*> saver{nullptr};
std::atomic<pid_t> ending{0};  // the thread that ends the process
pid_t looked_after = 0;        // the process whose end is to be told of

[[noreturn]] void leave(int code) noexcept {
  for (;;) syscall(SYS_exit_group, code);
}

/// "error: controller … of robot … at tick 17", or "error: tandem" when no plug-in is known to run on this thread.
void begin_message(hal::FixedText& text) noexcept {
  const hal::CallMark* mark = hal::known_thread_mark();
  if (mark == nullptr || !hal::name_call(*mark, text)) text << "tandem, in no code of a plug-in,";
}

/// The plug-in that a frame of the stack is in; empty: none. Not for signal handlers.
std::string plugin_of(void* frame) {
  Dl_info where{};
  if (::dladdr(frame, &where) == 0 || where.dli_fname == nullptr) return {};
  void* const library = ::dlopen(where.dli_fname, RTLD_LAZY | RTLD_NOLOAD);
  if (library == nullptr) return {};  // the program itself
  const bool exports = ::dlsym(library, "tandem_plugin") != nullptr;
  Dl_info definer{};
  const bool its_own = exports && ::dladdr(::dlsym(library, "tandem_plugin"), &definer) != 0 &&
                       definer.dli_fbase == where.dli_fbase;  // not one of the libraries that it uses
  ::dlclose(library);
  const std::string_view path = where.dli_fname;
  return its_own ? std::string(path.substr(path.rfind('/') + 1)) : std::string();
}

/// As `begin_message`, and names the plug-in whose code is on the stack of a thread that it has started itself.
void begin_message_by_stack(hal::FixedText& text) {
  const hal::CallMark* mark = hal::known_thread_mark();
  if (mark != nullptr && hal::name_call(*mark, text)) return;
  std::array<void*, 64> frames{};
  const int count = ::backtrace(frames.data(), static_cast<int>(frames.size()));
  for (int i = 0; i < count; ++i) {
    if (const std::string plugin = plugin_of(frames[static_cast<std::size_t>(i)]); !plugin.empty()) {
      text << "plug-in '" << plugin << "', on a thread of its own,";
      return;
    }
  }
  begin_message(text);
}

std::string_view meaning_of(int signal) noexcept {
  switch (signal) {
    case SIGSEGV:
      return "crashed: SIGSEGV (it used memory that is not its own)";
    case SIGBUS:
      return "crashed: SIGBUS (it used memory that is not there)";
    case SIGFPE:
      return "crashed: SIGFPE (a whole number divided by zero)";
    case SIGILL:
      return "crashed: SIGILL (no instruction of this processor)";
    case SIGTRAP:
      return "crashed: SIGTRAP (a library gave up)";
    default:
      return "crashed: SIGABRT (it called abort)";
  }
}

void on_signal(int signal) noexcept {
  hal::FixedText text;
  begin_message(text);
  text << " " << meaning_of(signal);
  end_now(text.view());
}

void on_exit_call(int status, void* /*unused*/) noexcept {
  const hal::CallMark* mark = hal::known_thread_mark();
  hal::FixedText text;
  if (mark == nullptr || !hal::name_call(*mark, text)) return;  // the program itself, at its end
  text << " called exit(" << std::int64_t{status} << ")";
  end_now(text.view());
}

void on_quick_exit() noexcept {
  on_exit_call(0, nullptr);
}

[[noreturn]] void on_terminate() noexcept {
  hal::FixedText text;
  begin_message_by_stack(text);
  const std::exception_ptr thrown = std::current_exception();
  try {
    if (thrown != nullptr) std::rethrow_exception(thrown);
    text << " called std::terminate";
  } catch (const std::bad_alloc&) {
    text << " ran out of memory";
  } catch (const std::exception& e) {
    text << " threw where nobody catches: " << hal::printable(hal::shortened(e.what()));
  } catch (...) {
    text << " threw where nobody catches";
  }
  end_now(text.view());
}

/// What plug-ins, and libraries that they bring, call instead of the C library's `_exit`, which would end the run
/// without a word.
[[noreturn]] void on_immediate_exit(int status) noexcept {
  if (getpid() != looked_after) leave(status);
  hal::FixedText text;
  const hal::CallMark* mark = hal::known_thread_mark();
  if (mark == nullptr || !hal::name_call(*mark, text)) text << "a thread that tandem does not know";
  text << " called _exit(" << std::int64_t{status} << ")";
  end_now(text.view());
}

}  // namespace

void catch_crashes() noexcept {
  looked_after = getpid();
  (void)hal::this_thread_mark();  // a stack for the handlers
  on_exit(&on_exit_call, nullptr);
  std::at_quick_exit(&on_quick_exit);
  std::set_terminate(&on_terminate);
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)  // they have handlers that say more
  struct sigaction action {};
  action.sa_handler = &on_signal;
  action.sa_flags = SA_ONSTACK;
  sigfillset(&action.sa_mask);
  for (const int signal : {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGTRAP, SIGABRT}) sigaction(signal, &action, nullptr);
#endif
}

void save_in_emergency(const EmergencySaver* last) noexcept {
  saver.store(last, std::memory_order_release);
}

bool write_now(int descriptor, std::string_view text) noexcept {
  while (!text.empty()) {
    const ssize_t n = write(descriptor, text.data(), text.size());
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) return false;
    text.remove_prefix(static_cast<std::size_t>(n));
  }
  return true;
}

void end_now(std::string_view message) noexcept {
  pid_t nobody = 0;
  if (!ending.compare_exchange_strong(nobody, gettid())) {
    if (nobody == gettid()) leave(kFailedRunning);  // it went wrong while it saved
    for (;;) pause();                               // another thread is at it
  }
  leave_screen_now();
  hal::FixedText text;
  for (const char c : message)
    text << (static_cast<unsigned char>(c) < 0x20 || c == 0x7F ? "?" : std::string_view(&c, 1));
  (void)write_now(STDERR_FILENO, isatty(STDERR_FILENO) != 0 ? "\r\033[Kerror: " : "error: ");
  (void)write_now(STDERR_FILENO, text.view());
  (void)write_now(STDERR_FILENO, "\n");
  if (const EmergencySaver* last = saver.load(std::memory_order_acquire); last != nullptr) last->save(text.view());
  leave(kFailedRunning);
}

}  // namespace tandem::app

// The program's own, found before the C library's by all that is loaded.
extern "C" {
[[gnu::noreturn, gnu::visibility("default")]] void _exit(int status) {
  tandem::app::on_immediate_exit(status);
}
[[gnu::noreturn, gnu::visibility("default")]] void _Exit(int status) noexcept {
  tandem::app::on_immediate_exit(status);
}
}
