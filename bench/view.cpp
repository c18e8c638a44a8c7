// What a window costs the run that it shows, and how soon it shows something.
#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fmt/format.h>
#include <optional>
#include <poll.h>
#include <thread>
#include <unistd.h>

#include "app/build_info.hpp"
#include "app/exit_code.hpp"
#include "app/outputs/report.hpp"
#include "app/process/measure.hpp"
#include "app/run_options.hpp"
#include "app/window/view_run.hpp"
#include "bench/bench.hpp"
#include "bench/spread.hpp"
#include "core/live/live_run.hpp"
#include "hal/output_file.hpp"
#include "hal/program.hpp"
#include "hal/temporary_folder.hpp"
#include "window/wire/client.hpp"

namespace tandem::bench {
namespace {

using namespace std::chrono_literals;
using window::Client;

constexpr std::uint32_t kPoses = 1;
constexpr int kWakeEvery_ms = 100;  // between looks whether this is to stop

/// Number of the frame that this is of; 0: of none.
std::uint32_t pose_frame(const Client::Received& received) {
  std::uint32_t header[2] = {};
  if (received.kind != Client::Received::Kind::Binary || received.bytes.size() < sizeof header) return 0;
  std::memcpy(header, received.bytes.data(), sizeof header);
  return header[0] == kPoses ? header[1] : 0;
}

/// Takes all that comes, as a page does, and acknowledges frames.
class Onlooker {
 public:
  Onlooker(const std::string& address, double frames_per_s) {
    auto joined = Client::connect(address);
    if (!joined.ok()) return;
    client_ = std::move(joined).value();
    (void)client_->send(R"({"do":"got","frame":0})");
    (void)client_->send(R"({"do":"rate","frames_per_s":)" + std::to_string(frames_per_s) + "}");
    thread_ = std::thread([this] { look(); });
  }
  ~Onlooker() {
    over_ = true;
    if (thread_.joinable()) thread_.join();
  }
  Onlooker(const Onlooker&) = delete;
  Onlooker& operator=(const Onlooker&) = delete;
  std::int64_t frames() const noexcept { return frames_; }
  std::int64_t bytes() const noexcept { return bytes_; }

 private:
  void look() {
    while (!over_) {
      const auto received = client_->receive(20ms);
      if (!received) continue;
      if (received->kind == Client::Received::Kind::Close) return;
      const std::uint32_t number = pose_frame(*received);
      if (number == 0) continue;
      ++frames_;
      bytes_ += static_cast<std::int64_t>(received->bytes.size());
      (void)client_->send(R"({"do":"got","frame":)" + std::to_string(number) + "}");
    }
  }
  std::optional<Client> client_;
  std::atomic<bool> over_{false};
  std::atomic<std::int64_t> frames_{0}, bytes_{0};
  std::thread thread_;
};

struct Half {
  double wall_s = 0.0, own_cpu_s = 0.0;
};

/// Steps as run.cpp does.
Half step(core::World& world, core::LiveRun& live, app::RunView& view, std::int64_t ticks) {
  const double wall = app::wall_seconds(), cpu = app::seconds_of(CLOCK_THREAD_CPUTIME_ID);
  for (std::int64_t i = 0; i < ticks && live.before_step(); ++i) {
    world.step();
    if (live.after_step()) view.tick_done();
  }
  return {app::wall_seconds() - wall, app::seconds_of(CLOCK_THREAD_CPUTIME_ID) - cpu};
}

/// Four decimals.
double rounded(double value) {
  return std::atof(fmt::format("{:.4f}", value).c_str());
}

/// `tandem view` of a file; ended with this.
class Viewing {
 public:
  explicit Viewing(const std::string& file) {
    const std::string program = std::filesystem::read_symlink("/proc/self/exe").string();
    auto started = hal::Program::start_source(
        "/bin/sh", {"-c", "exec \"$0\" view \"$1\" --no-browser 2>&1 >/dev/null", program, file});
    if (started.ok()) program_ = std::move(started).value();
  }

  /// What stands behind "view: "; else all that it said.
  hal::Result<std::string> address(const std::atomic<bool>& stop) const {
    std::string text;
    char buffer[512];
    pollfd ready{program_ == nullptr ? -1 : program_->output(), POLLIN, 0};
    while (program_ != nullptr && !stop.load()) {
      if (::poll(&ready, 1, kWakeEvery_ms) <= 0) continue;
      const ssize_t got = ::read(ready.fd, buffer, sizeof buffer);
      if (got <= 0) break;
      text.append(buffer, static_cast<std::size_t>(got));
      const std::size_t at = text.find("http://");
      const std::size_t end = at == std::string::npos ? at : text.find('\n', at);
      if (end != std::string::npos) return text.substr(at, end - at);
    }
    return hal::Error{"tandem view tells no address: " + text};
  }

 private:
  std::unique_ptr<hal::Program> program_;
};

/// Seconds from the start of `tandem view` of the file.
struct Shown {
  double address_s = 0.0, frame_s = 0.0;
};

hal::Result<Shown> show(const std::string& file, const std::atomic<bool>& stop) {
  Shown shown;
  const double began = app::wall_seconds();
  const Viewing viewing(file);
  const auto address = viewing.address(stop);
  if (!address.ok()) return address.error();
  shown.address_s = app::wall_seconds() - began;
  auto client = Client::connect(address.value());
  if (!client.ok()) return client.error();
  const double latest_s = app::wall_seconds() + 30.0;
  for (;;) {
    const auto received = client.value().receive(std::chrono::milliseconds(kWakeEvery_ms));
    const bool closed = received && received->kind == Client::Received::Kind::Close;
    if (closed || stop.load() || app::wall_seconds() > latest_s) return hal::Error{"tandem view shows no frame"};
    if (!received || pose_frame(*received) == 0) continue;
    shown.frame_s = app::wall_seconds() - began;
    return shown;
  }
}

/// How soon a thousand robots are seen: medians.
hal::Status first_frame(std::int64_t repeat, const std::atomic<bool>& stop) {
  constexpr std::int64_t kRobots = 1000;
  const double half_m = 0.25 * std::sqrt(static_cast<double>(kRobots));
  const hal::TemporaryFolder folder("tandem_view");
  const std::string file = folder.file("view.xml");
  const hal::Status written = hal::write_whole_file(
      file, "experiment",
      fmt::format(fmt::runtime(hal::carried_text(scene_files(), "view.xml")), 2.0 * half_m + 1.0, half_m, kRobots));
  if (!written.ok()) return written;
  std::vector<double> address_s, frame_s;
  for (std::int64_t i = 0; i < repeat; ++i) {
    const auto shown = show(file, stop);
    if (!shown.ok()) return shown.error();
    address_s.push_back(shown.value().address_s);
    frame_s.push_back(shown.value().frame_s);
  }
  print_line({{"bench", "view"},
              {"robots", kRobots},
              {"address_s", rounded(spread_of(address_s).median)},
              {"first_frame_s", rounded(spread_of(frame_s).median)},
              {"first_frame_s_largest", rounded(spread_of(frame_s).largest)}});
  return {};
}

/// Runs the scene behind a window, as fast as possible, in pairs without a viewer and with one, on a thread of this
/// process: quotients of wall time and of the stepping thread's processor time.
hal::Status cost(const BenchCase& c, const Call& call) {
  const auto world = world_of(scene_of(c), call.loader);
  if (world == nullptr) return hal::Error{"the scene cannot be made"};
  const std::int64_t pairs = call.options.repeat;
  const double frames_per_s = c.robots > 20'000 ? 10.0 : 20.0;  // that the viewer asks for
  core::LiveOptions options;
  options.can_go_back = false;
  options.stop = &call.stop;
  core::LiveRun live(*world, options);
  app::ViewRequest request;
  request.no_browser = true;
  auto view = app::RunView::open(request, {*world, live, call.loader.catalog(), nullptr, {}});
  if (!view.ok()) return view.error();
  live.on_show([&] { view.value()->show(); });
  world->start();
  live.start();

  (void)step(*world, live, *view.value(), c.ticks);  // warm
  std::vector<double> wall, own;
  std::int64_t frames = 0, bytes = 0;
  double watched_s = 0.0;
  const auto alone = [&] { return step(*world, live, *view.value(), c.ticks); };
  const auto watched = [&] {
    Onlooker onlooker(view.value()->address(), frames_per_s);
    while (onlooker.frames() == 0 && !call.stop.load())
      (void)step(*world, live, *view.value(), 1);  // members and scene are told once
    const std::int64_t frames_before = onlooker.frames(), bytes_before = onlooker.bytes();
    const Half half = step(*world, live, *view.value(), c.ticks);
    frames += onlooker.frames() - frames_before;
    bytes += onlooker.bytes() - bytes_before;
    watched_s += half.wall_s;
    return half;
  };
  for (std::int64_t pair = 0; pair < pairs && !call.stop.load(); ++pair) {  // in turns, so that what drifts meets both
    Half without = pair % 2 == 0 ? alone() : Half{};
    const Half with = watched();
    if (pair % 2 != 0) without = alone();
    wall.push_back(with.wall_s / without.wall_s);
    own.push_back(with.own_cpu_s / without.own_cpu_s);
  }
  if (call.stop.load()) return hal::Error{"interrupted"};
  print_line({{"bench", "view"},
              {"robots", c.robots},
              {"engine", c.engine},
              {"threads", c.threads},
              {"ticks", c.ticks},
              {"pairs", pairs},
              {"wall_quotient", rounded(spread_of(wall).median)},
              {"wall_quotient_smallest", rounded(spread_of(wall).smallest)},
              {"wall_quotient_largest", rounded(spread_of(wall).largest)},
              {"stepping_cpu_quotient", rounded(spread_of(own).median)},
              {"frames_per_s", rounded(static_cast<double>(frames) / watched_s)},
              {"bytes_per_robot_and_frame",
               rounded(static_cast<double>(bytes) / static_cast<double>(std::max<std::int64_t>(1, frames) * c.robots))},
              {"state_hash", app::hash_text(world->state_hash())},
              {"cpu_model", app::build_info().processor}});
  return {};
}

}  // namespace

hal::Result<int> bench_view(const Call& call) {
  BenchCase c{.robot = call.robot, .ticks = call.options.ticks};
  for (const std::string& engine : call.engines) {
    for (const std::int64_t robots : call.options.robots_or({10'000, 100'000})) {
      for (const std::int64_t threads : call.threads) {
        c.engine = engine;
        c.robots = robots;
        c.threads = threads;
        if (const hal::Status done = cost(c, call); !done.ok()) return done.error();
      }
    }
  }
  const hal::Status seen = first_frame(call.options.repeat, call.stop);
  return seen.ok() ? hal::Result<int>(app::kDone) : seen.error();
}

}  // namespace tandem::bench
