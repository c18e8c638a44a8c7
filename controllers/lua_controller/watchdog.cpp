#include "controllers/lua_controller/watchdog.hpp"

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <csignal>
#include <memory>
#include <mutex>
#include <thread>
#include <vector>

#include "controllers/lua_controller/interpreter.hpp"

namespace tandem::controllers::lua {
namespace {

class Watchdog {
 public:
  Watchdog() {
    sigset_t all;
    sigset_t before;
    sigfillset(&all);
    pthread_sigmask(SIG_SETMASK, &all, &before);  // signals are others' affair
    thread_ = std::thread([this] { run(); });
    pthread_sigmask(SIG_SETMASK, &before, nullptr);
  }
  ~Watchdog() {
    {
      const std::lock_guard hold(lock_);
      ending_ = true;
    }
    wake_.notify_all();
    thread_.join();
  }
  void add(Interpreter& one) {
    const std::lock_guard hold(lock_);
    all_.push_back(&one);
  }
  void remove(Interpreter& one) {
    const std::lock_guard hold(lock_);
    std::erase(all_, &one);
  }
  bool idle() {
    const std::lock_guard hold(lock_);
    return all_.empty();
  }

 private:
  void run() {
    std::unique_lock hold(lock_);
    while (!wake_.wait_for(hold, std::chrono::milliseconds(100), [this] { return ending_; })) {
      for (Interpreter* const one : all_) one->look();
    }
  }

  std::mutex lock_;
  std::condition_variable wake_;
  bool ending_ = false;
  std::vector<Interpreter*> all_;
  std::thread thread_;
};

std::mutex guard;
std::unique_ptr<Watchdog> watchdog;

}  // namespace

void watch(Interpreter& interpreter) {
  const std::lock_guard hold(guard);
  if (watchdog == nullptr) watchdog = std::make_unique<Watchdog>();
  watchdog->add(interpreter);
}

void unwatch(Interpreter& interpreter) noexcept {
  const std::lock_guard hold(guard);
  watchdog->remove(interpreter);
  if (watchdog->idle()) watchdog.reset();
}

int watchdog_signal() noexcept {
  return SIGRTMIN + 7;
}

}  // namespace tandem::controllers::lua
