#include "app/window/script_watch.hpp"

#include <chrono>
#include <condition_variable>
#include <fmt/format.h>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "core/live/source_files.hpp"
#include "hal/input_file.hpp"

namespace tandem::app {
namespace {

using hal::Json;
using namespace std::chrono_literals;

constexpr auto kEvery = 200ms;

/// None: it cannot be read now; editors replace files by others.
std::optional<std::string> text_of_file(const std::string& path) {
  auto text = hal::read_whole_file(path, "the script");
  return text.ok() ? std::optional(std::move(text).value()) : std::nullopt;
}

}  // namespace

struct ScriptWatch::Impl : std::enable_shared_from_this<ScriptWatch::Impl> {
  struct File {
    std::string name, path;
    std::string tried;  ///< what the run was last asked to run, or runs
    std::string seen;   ///< at the last look
  };

  Impl(core::LiveRun& l, const hal::Log& g) : live(l), log(g) {}

  core::LiveRun& live;
  const hal::Log log;
  std::thread thread;
  std::mutex lock;
  std::condition_variable changed;
  bool ended = false;                              // with `lock`, as the next
  std::map<std::string, std::vector<File>> files;  // by configuration

  /// Takes over which files there are now; what was tried with them stays.
  void take(const Json& listed) {
    const std::lock_guard hold(lock);
    for (const auto& [controller, list] : listed.items()) {
      std::vector<File> before = std::move(files[controller]);
      std::vector<File>& now = files[controller];
      now.clear();
      for (const Json& one : list) {
        File file{one["name"].get<std::string>(), one["path"].get<std::string>(), one["text"].get<std::string>(), {}};
        file.seen = file.tried;
        for (File& known : before) {
          if (known.name == file.name) file = std::move(known);
        }
        now.push_back(std::move(file));
      }
    }
  }

  /// Looks once. @returns actions for what has changed and has stayed so since the look before.
  std::vector<Json> look() {
    const std::lock_guard hold(lock);
    std::vector<Json> actions;
    for (auto& [controller, list] : files) {
      bool other = false;
      bool settled = true;
      for (File& file : list) {
        std::string text = text_of_file(file.path).value_or(file.seen);
        settled = settled && text == file.seen;
        other = other || text != file.tried;
        file.seen = std::move(text);
      }
      if (!other || !settled) continue;
      Json texts = Json::object();
      for (File& file : list) texts[file.name] = file.tried = file.seen;
      actions.push_back({{"do", "reload"}, {"controller", controller}, {"files", std::move(texts)}});
    }
    return actions;
  }

  void watch() {
    std::unique_lock hold(lock);
    while (!ended) {
      changed.wait_for(hold, kEvery, [this] { return ended; });
      if (ended) return;
      hold.unlock();
      for (Json& action : look()) post(std::move(action));
      hold.lock();
    }
  }

  void post(Json action) {
    const auto controller = action["controller"].get<std::string>();
    live.post(std::move(action), [self = shared_from_this(), controller](const Json& answer) {
      {
        const std::lock_guard hold(self->lock);
        if (self->ended) return;
      }
      self->tell(controller, answer);
      self->live.post({{"do", "source_files"}}, [self](const Json& listed) {
        if (listed.contains("controllers")) self->take(listed["controllers"]);
      });
    });
  }

  void tell(const std::string& controller, const Json& answer) {
    if (!answer.value("ok", false)) {
      log.error(fmt::format("controller '{}': its changed script is not taken, and the old one goes on: {}", controller,
                            answer.value("error", std::string())));
      return;
    }
    const auto robots = answer.value("robots", std::int64_t{0});
    if (robots > 0) {
      log.info(fmt::format("controller '{}': {} robot{} began anew at tick {} with its changed script", controller,
                           robots, robots == 1 ? "" : "s", answer.value("tick", std::int64_t{0})));
    }
    if (const auto stopped = answer.value("stopped", std::int64_t{0}); stopped > 0)
      log.error(fmt::format("controller '{}': {} robots could not begin with its changed script and are stopped: {}",
                            controller, stopped, answer.value("error_of_first", std::string())));
  }
};

ScriptWatch::ScriptWatch(core::LiveRun& live, core::World& world, const hal::Log& log)
    : impl_(std::make_shared<Impl>(live, log)) {
  impl_->take(core::source_files(world));
  if (impl_->files.empty()) return;
  live.add_command("source_files", [&world](const Json&) -> hal::Result<Json> {
    return Json{{"controllers", core::source_files(world)}};
  });
  impl_->thread = std::thread([impl = impl_.get()] { impl->watch(); });
}

ScriptWatch::~ScriptWatch() {
  {
    const std::lock_guard hold(impl_->lock);
    impl_->ended = true;
  }
  impl_->changed.notify_all();
  if (impl_->thread.joinable()) impl_->thread.join();
}

}  // namespace tandem::app
