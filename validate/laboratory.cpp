#include "validate/laboratory.hpp"

#include <algorithm>
#include <arpa/inet.h>
#include <cmath>
#include <csignal>
#include <cstdlib>
#include <fmt/format.h>
#include <fstream>
#include <memory>
#include <sstream>
#include <stdexcept>
#include <sys/socket.h>
#include <thread>
#include <unistd.h>

#include "hal/input_file.hpp"
#include "hal/processor_waits.hpp"
#include "hal/program.hpp"
#include "validate/scene.hpp"

namespace tandem::validate {
namespace {

std::string own_program() {
  return std::filesystem::read_symlink("/proc/self/exe").string();
}

/// A UDP port that nobody uses now; 0: none.
int free_port() {
  const int fd = ::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  socklen_t size = sizeof address;
  int port = 0;
  if (::bind(fd, reinterpret_cast<const sockaddr*>(&address), size) == 0 &&
      ::getsockname(fd, reinterpret_cast<sockaddr*>(&address), &size) == 0)
    port = ntohs(address.sin_port);
  ::close(fd);
  return port;
}

std::string experiment_of(const MixedRun& run, const std::filesystem::path& folder, int port) {
  std::string robots;
  for (const EmulatedRobot& r : run.robots)
    robots += fmt::format(
        "<foot-bot id=\"{0}\"><body position=\"{1},{2},0\" orientation=\"{3},0,0\"/><controller config=\"c\"/>"
        "<bridge link=\"slcan:{4}/{0}@1000000\" map=\"{4}/map.xml\"/><tracker/></foot-bot>\n",
        r.id, r.x_m, r.y_m, r.heading_deg, folder.string());
  return fmt::format(
      "<tandem><framework><experiment length=\"{}\" ticks_per_second=\"10\" random_seed=\"1\"/><time "
      "mode=\"realtime\"/></framework>\n"
      "<controllers><lua_controller id=\"c\" library=\"lua_controller\"><actuators><differential_steering/></actuators>"
      "<sensors><wheel_encoders/></sensors><params script=\"{}/drive.lua\"/></lua_controller></controllers>\n"
      "<arena size=\"60,60,2\" center=\"0,0,1\">\n{}</arena>\n<trackers><udp port=\"{}\" clock=\"monotonic\" sd=\"2 "
      "mm\" sd_heading=\"0.01\"/></trackers>\n"
      "{}<physics_engines><kinematics2d id=\"k\"/></physics_engines></tandem>\n",
      run.seconds, folder.string(), robots, port, run.safety);
}

using Programs = std::vector<std::unique_ptr<hal::Program>>;

hal::Status start(Programs& running, const std::vector<std::string>& arguments) {
  auto started = hal::Program::start(own_program(), arguments);
  if (!started.ok()) return started.error();
  running.push_back(std::move(started).value());
  return {};
}

/// Until a file is there, for at most 20 s.
bool appears(const std::filesystem::path& file) {
  for (int i = 0; i < 400; ++i) {
    if (std::filesystem::exists(file)) return true;
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
  }
  return false;
}

hal::Status start_robots(Programs& running, const MixedRun& run, const std::filesystem::path& folder, int port) {
  std::string sees;
  for (const EmulatedRobot& r : run.robots) {
    const std::string link = (folder / r.id).string();
    std::vector<std::string> arguments = {"emulate",   "footbot",
                                          "--link",    "pty:" + link,
                                          "--log",     link + ".log",
                                          "--poses",   "100",
                                          "--x",       fmt::format("{}", r.x_m),
                                          "--y",       fmt::format("{}", r.y_m),
                                          "--heading", fmt::format("{} deg", r.heading_deg)};
    arguments.insert(arguments.end(), r.options.begin(), r.options.end());
    if (const hal::Status started = start(running, arguments); !started.ok()) return started;
    if (!appears(link)) return hal::Error{"the emulated robot " + r.id + " does not come up"};
    sees += (sees.empty() ? "" : " ") + r.id + "=" + link + ".log";
  }
  return start(running,
               {"emulate", "tracker", "--link", fmt::format("udp:127.0.0.1:{}", port), "--sees", sees, "--rate", "30",
                "--delay", "0.06", "--noise", "0.002", "--heading_noise", "0.01", "--clock", "monotonic"});
}

hal::Result<std::string> output_of(const std::vector<std::string>& arguments) {
  const auto ended = hal::run_program(own_program(), arguments);
  if (!ended.ok()) return ended.error();
  if (ended.value().code != 0)
    return hal::Error{
        fmt::format("tandem {} ended with {}: {}", arguments.front(), ended.value().code, ended.value().errors)};
  return ended.value().output;
}

/// Of this process and of what it has started, and so on.
void look_at_all(hal::ProcessorWaits& waits, pid_t process) {
  waits.look(process);
  std::error_code gone;
  for (const auto& thread : std::filesystem::directory_iterator(fmt::format("/proc/{}/task", process), gone)) {
    std::ifstream children(thread.path() / "children");
    for (pid_t child = 0; children >> child;) look_at_all(waits, child);
  }
}

/// Looks at all processes every 0.2 s, as long as it lives. What this one waited before has nothing to do with it.
class Watch {
 public:
  Watch() : thread_([this](const std::stop_token& end) { look(end); }) {}
  /// Ends it.
  hal::TimeNs longest_ns() {
    thread_.request_stop();
    if (thread_.joinable()) thread_.join();
    return waits_.longest_ns();
  }

 private:
  void look(const std::stop_token& end) {
    waits_.begin(::getpid());
    for (auto next = std::chrono::steady_clock::now(); !end.stop_requested(); std::this_thread::sleep_until(next)) {
      look_at_all(waits_, ::getpid());
      next += std::chrono::milliseconds(200);
    }
  }
  hal::ProcessorWaits waits_;
  std::jthread thread_;
};

std::vector<std::string> split(const std::string& line) {
  std::vector<std::string> cells;
  std::istringstream in(line);
  for (std::string cell; std::getline(in, cell, ',');) cells.push_back(cell);
  return cells;
}

}  // namespace

TruePlace place_at(const TrueTrack& track, double t_ns) {
  const auto after =
      std::lower_bound(track.begin(), track.end(), t_ns, [](const TruePlace& p, double t) { return p.t_ns < t; });
  if (after == track.begin()) return track.front();
  if (after == track.end()) return track.back();
  const TruePlace &a = *(after - 1), &b = *after;
  const double part = (t_ns - a.t_ns) / (b.t_ns - a.t_ns);
  return {t_ns, a.x_m + part * (b.x_m - a.x_m), a.y_m + part * (b.y_m - a.y_m),
          a.heading_rad + part * std::remainder(b.heading_rad - a.heading_rad, 2.0 * M_PI)};
}

std::size_t RecordTable::column(const std::string& name) const {
  const auto found = std::find(columns.begin(), columns.end(), name);
  if (found == columns.end()) throw std::out_of_range("the record has no column " + name);
  return static_cast<std::size_t>(found - columns.begin());
}

hal::Result<std::unique_ptr<Laboratory>> Laboratory::run(const MixedRun& run) {
  std::signal(SIGPIPE, SIG_IGN);
  std::unique_ptr<Laboratory> made(new Laboratory);
  const std::filesystem::path& folder = made->folder_.path();
  std::ofstream(folder / "drive.lua") << run.script;
  std::ofstream(folder / "map.xml") << scene_text("../configs/footbot_map.xml");
  const int port = free_port();
  std::ofstream(folder / "run.xml") << experiment_of(run, folder, port);
  Programs running;
  Watch watch;
  if (const hal::Status started = start_robots(running, run, folder, port); !started.ok()) return started.error();
  const auto done =
      output_of({"run", (folder / "run.xml").string(), "--record", (folder / "run.record").string(), "--quiet"});
  if (!done.ok()) return done.error();
  made->longest_wait_ns_ = watch.longest_ns();
  return made;
}

hal::Result<TrueTrack> Laboratory::log_of(const std::string& id) const {
  std::ifstream in(folder_.file(id + ".log"));
  TrueTrack track;
  for (std::string line; std::getline(in, line);) {
    if (line.find("\"pose\"") == std::string::npos) continue;
    const auto parsed = hal::parse_json_object(line);
    if (!parsed.ok()) continue;
    const hal::Json& json = parsed.value();
    if (json.value("event", "") != "pose") continue;
    track.push_back({json.value("taken_t_ns", 0.0), json.value("x_m", 0.0), json.value("y_m", 0.0),
                     json.value("heading_rad", 0.0)});
  }
  std::sort(track.begin(), track.end(), [](const TruePlace& a, const TruePlace& b) { return a.t_ns < b.t_ns; });
  if (track.size() < 2) return hal::Error{"the log of " + id + " tells no places"};
  return track;
}

std::vector<double> Laboratory::told_of(const std::string& id) const {
  std::ifstream in(folder_.file(id + ".log"));
  std::vector<double> times;
  for (std::string line; std::getline(in, line);) {
    if (line.find("\"wheels\"") == std::string::npos) continue;
    const auto parsed = hal::parse_json_object(line);
    if (!parsed.ok()) continue;
    const hal::Json& json = parsed.value();
    if (json.value("event", "") == "wheels" && json.value("changed", false)) times.push_back(json.value("t_ns", 0.0));
  }
  return times;
}

hal::Result<RecordTable> Laboratory::table(const std::string& name) const {
  const auto text = output_of({"export", folder_.file("run.record"), "--csv", "-", "--table", name});
  if (!text.ok()) return text.error();
  RecordTable table;
  std::istringstream in(text.value());
  std::string line;
  std::getline(in, line);
  table.columns = split(line);
  while (std::getline(in, line)) {
    const std::vector<std::string> cells = split(line);
    std::vector<double> numbers;
    for (std::size_t i = 0; i < table.columns.size(); ++i)
      numbers.push_back(i >= cells.size() || cells[i].empty() || i == 2 ? NAN : std::strtod(cells[i].c_str(), nullptr));
    if (cells.size() > 2) table.rows[cells[2]].push_back(std::move(numbers));
  }
  return table;
}

hal::Result<hal::Json> Laboratory::fit() const {
  const std::string report = folder_.file("fit.json");
  const auto done = output_of({"fit", folder_.file("run.record"), "--report", report});
  if (!done.ok()) return done.error();
  const auto text = hal::read_whole_file(report, "the report of tandem fit");
  return text.ok() ? hal::parse_json_object(text.value()) : text.error();
}

void in_fair_trials(Part& part, const MixedRun& run, const std::function<void(Part&, const Laboratory&)>& judge) {
  constexpr int kMostTrials = 3;
  constexpr hal::TimeNs kMostWaiting_ns = 60 * hal::kNsPerMs;
  Table trials{
      "Trials",
      "Runs in real time. A trial in which something is not met, and in which a thread of hub, robots or tracker "
      "waited 60 ms and more of 200 ms for a processor, is void: the machine was busy. It is made again.",
      {"trial", "longest wait for a processor", "slots without a tick", "judgement"},
      {}};
  for (int trial = 1;; ++trial) {
    auto made = Laboratory::run(run);
    if (!made.ok()) throw std::runtime_error(made.error().message);
    const Laboratory& lab = *made.value();
    const auto clocks = lab.table("run time clock");
    if (!clocks.ok()) throw std::runtime_error(clocks.error().message);
    const std::size_t skipped = clocks.value().column("skipped_slots");
    Part judged{"", ""};
    judge(judged, lab);
    bool met = true;
    for (const Table& table : judged.tables)
      for (const Row& row : table.rows) met &= row.verdict != Verdict::NotMet;
    const bool is_void = !met && lab.longest_wait_ns() >= kMostWaiting_ns;
    trials.rows.push_back(
        {{fmt::format("{}", trial), fmt::format("{:.0f} ms", static_cast<double>(lab.longest_wait_ns()) / 1e6),
          fmt::format("{:.0f}", clocks.value().rows.at("run").back()[skipped]), is_void ? "void" : "counts"}});
    if (is_void && trial < kMostTrials) continue;
    for (Table& table : judged.tables) {
      for (Row& row : table.rows)
        if (is_void && row.verdict == Verdict::NotMet) row.verdict = Verdict::NotMade;
      part.tables.push_back(std::move(table));
    }
    for (Figure& figure : judged.figures) part.figures.push_back(std::move(figure));
    part.tables.push_back(std::move(trials));
    return;
  }
}

}  // namespace tandem::validate
