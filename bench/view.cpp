#include "bench/view.hpp"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fcntl.h>
#include <filesystem>
#include <fmt/format.h>
#include <fstream>
#include <optional>
#include <spawn.h>
#include <sys/wait.h>
#include <thread>
#include <unistd.h>

#include "app/build_info.hpp"
#include "app/experiment/reading.hpp"
#include "app/process/measure.hpp"
#include "app/run_options.hpp"
#include "app/window/view_run.hpp"
#include "bench/scene.hpp"
#include "bench/spread.hpp"
#include "core/live/live_run.hpp"
#include "core/sim/world.hpp"
#include "window/wire/client.hpp"

namespace tandem::bench {
namespace {

using namespace std::chrono_literals;
using window::Client;

constexpr std::uint32_t kPoses = 1;

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

constexpr const char* kExperiment = R"(<?xml version="1.0"?>
<tandem>
  <framework><experiment length="0" ticks_per_second="10" random_seed="1"/></framework>
  <controllers>
    <epuck_diffusion id="c" library="epuck_diffusion">
      <actuators><differential_steering/></actuators><sensors><proximity/></sensors><params/>
    </epuck_diffusion>
  </controllers>
  <arena size="{0},{0},1">
    <distribute>
      <position method="uniform" min="-{1},-{1},0" max="{1},{1},0"/><orientation method="uniform" min="0,0,0" max="360,0,0"/>
      <entity quantity="{2}" max_trials="1000"><e-puck id="ep"><controller config="c"/></e-puck></entity>
    </distribute>
  </arena>
  <physics_engines><kinematics2d id="k"/></physics_engines>
</tandem>
)";

/// `tandem view` of this file; killed when this ends.
class Viewing {
 public:
  explicit Viewing(const std::string& file) {
    int ends[2] = {-1, -1};
    if (::pipe2(ends, O_CLOEXEC) != 0) return;
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_adddup2(&actions, ends[1], STDERR_FILENO);
    posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
    std::string words[] = {"/proc/self/exe", "view", file, "--no-browser"};
    char* arguments[] = {words[0].data(), words[1].data(), words[2].data(), words[3].data(), nullptr};
    const std::string program = std::filesystem::read_symlink("/proc/self/exe").string();
    if (::posix_spawn(&child_, program.c_str(), &actions, nullptr, arguments, environ) != 0) child_ = -1;
    posix_spawn_file_actions_destroy(&actions);
    ::close(ends[1]);
    errors_ = ends[0];
  }
  ~Viewing() {
    if (child_ > 0) {
      ::kill(child_, SIGKILL);
      ::waitpid(child_, nullptr, 0);
    }
    if (errors_ >= 0) ::close(errors_);
  }
  Viewing(const Viewing&) = delete;
  Viewing& operator=(const Viewing&) = delete;

  /// What stands behind "view: "; else all that it said.
  hal::Result<std::string> address() const {
    std::string text;
    char buffer[512];
    while (errors_ >= 0) {
      const std::size_t at = text.find("http://");
      const std::size_t end = at == std::string::npos ? at : text.find('\n', at);
      if (end != std::string::npos) return text.substr(at, end - at);
      const ssize_t got = ::read(errors_, buffer, sizeof buffer);
      if (got <= 0) break;
      text.append(buffer, static_cast<std::size_t>(got));
    }
    return hal::Error{"tandem view tells no address: " + text};
  }

 private:
  pid_t child_ = -1;
  int errors_ = -1;
};

}  // namespace

hal::Status bench_view(const ViewCase& c, hal::PluginLoader& loader) {
  BenchCase scene;
  scene.bench = "diffusion";
  scene.robot = c.robot;
  scene.engine = c.engine;
  scene.partition = scene.regions = "auto";
  scene.density = "equal";
  scene.robots = c.robots;
  scene.threads = c.threads;
  core::Problems problems;
  const auto world = core::World::make(scene_of(scene), loader, {}, problems);
  app::print_problems(problems);
  if (world == nullptr) return hal::Error{"the scene cannot be made"};
  core::LiveOptions options;
  options.can_go_back = false;
  core::LiveRun live(*world, options);
  app::ViewRequest request;
  request.no_browser = true;
  auto view = app::RunView::open(request, {*world, live, loader.catalog(), nullptr, {}});
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
    Onlooker onlooker(view.value()->address(), c.frames_per_s);
    while (onlooker.frames() == 0) (void)step(*world, live, *view.value(), 1);  // members and scene are told once
    const std::int64_t frames_before = onlooker.frames(), bytes_before = onlooker.bytes();
    const Half half = step(*world, live, *view.value(), c.ticks);
    frames += onlooker.frames() - frames_before;
    bytes += onlooker.bytes() - bytes_before;
    watched_s += half.wall_s;
    return half;
  };
  for (std::int64_t pair = 0; pair < c.pairs; ++pair) {  // in turns, so that what drifts meets both
    Half without, with;
    if (pair % 2 == 0) {
      without = alone();
      with = watched();
    } else {
      with = watched();
      without = alone();
    }
    wall.push_back(with.wall_s / without.wall_s);
    own.push_back(with.own_cpu_s / without.own_cpu_s);
  }
  const hal::Json line = {
      {"bench", "view"},
      {"robots", c.robots},
      {"engine", c.engine},
      {"threads", c.threads},
      {"ticks", c.ticks},
      {"pairs", c.pairs},
      {"wall_quotient", rounded(spread_of(wall).median)},
      {"wall_quotient_smallest", rounded(spread_of(wall).smallest)},
      {"wall_quotient_largest", rounded(spread_of(wall).largest)},
      {"stepping_cpu_quotient", rounded(spread_of(own).median)},
      {"frames_per_s", rounded(static_cast<double>(frames) / watched_s)},
      {"bytes_per_robot_and_frame",
       rounded(static_cast<double>(bytes) / static_cast<double>(std::max<std::int64_t>(1, frames) * c.robots))},
      {"state_hash", fmt::format("0x{:016x}", world->state_hash())},
      {"cpu_model", app::build_info().processor}};
  fmt::print("{}\n", hal::to_text(line));
  std::fflush(stdout);
  return {};
}

hal::Status bench_first_frame(std::int64_t robots, std::int64_t repeat) {
  const double half_m = 0.25 * std::sqrt(static_cast<double>(robots));
  char file[] = "/tmp/tandem_view_XXXXXX.xml";
  const int fd = ::mkstemps(file, 4);
  if (fd < 0) return hal::Error{"/tmp cannot be written"};
  ::close(fd);
  std::ofstream(file) << fmt::format(kExperiment, 2.0 * half_m + 1.0, half_m, robots);
  std::vector<double> address_s, frame_s;
  hal::Status status;
  for (std::int64_t i = 0; i < std::max<std::int64_t>(1, repeat) && status.ok(); ++i) {
    const double began = app::wall_seconds();
    const Viewing viewing(file);
    const auto address = viewing.address();
    if (!address.ok()) status = address.error();
    if (!address.ok()) break;
    address_s.push_back(app::wall_seconds() - began);
    auto client = Client::connect(address.value());
    if (!client.ok()) {
      status = client.error();
      break;
    }
    for (;;) {
      const auto received = client.value().receive(30s);
      if (!received || received->kind == Client::Received::Kind::Close) {
        status = hal::Error{"tandem view shows no frame"};
        break;
      }
      if (pose_frame(*received) == 0) continue;
      frame_s.push_back(app::wall_seconds() - began);
      break;
    }
  }
  std::error_code ignored;
  std::filesystem::remove(file, ignored);
  if (!status.ok()) return status;
  const hal::Json line = {{"bench", "view"},
                          {"robots", robots},
                          {"address_s", rounded(spread_of(address_s).median)},
                          {"first_frame_s", rounded(spread_of(frame_s).median)},
                          {"first_frame_s_largest", rounded(spread_of(frame_s).largest)}};
  fmt::print("{}\n", hal::to_text(line));
  std::fflush(stdout);
  return {};
}

}  // namespace tandem::bench
