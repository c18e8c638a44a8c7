// What a real buggy does, on a pseudo-terminal: written from the protocol in buggy.hpp alone.
#include <array>
#include <cmath>
#include <cstdio>
#include <poll.h>

#include "bridges/emulation/emulator_type.hpp"
#include "bridges/emulation/event_log.hpp"
#include "bridges/emulation/serial_port.hpp"
#include "bridges/link/link.hpp"
#include "buggy.hpp"
#include "hal/device/wheels.hpp"

namespace buggy {
namespace {

using namespace tandem;
using hal::kNsPerMs;
using hal::TimeNs;

constexpr TimeNs kStopsAfter = 500 * kNsPerMs;  // without a command
constexpr TimeNs kTurn = 10 * kNsPerMs;

/// The robot. Its wheels turn as they are told, or as those of a simulated robot do.
class Buggy {
 public:
  explicit Buggy(bridges::SharedPorts* body) : body_(body) {}

  void command(double left_mm_s, double right_mm_s, TimeNs now) {
    told_ns_ = now;
    set(left_mm_s, right_mm_s);
  }
  /// @returns whether it has stopped by itself
  bool turn(TimeNs now) {
    const double dt_s = turned_ns_ == 0 ? 0.0 : hal::to_seconds(now - turned_ns_);
    turned_ns_ = now;
    left_mm_ += left_mm_s_ * dt_s;
    right_mm_ += right_mm_s_ * dt_s;
    if (!moves() || now - told_ns_ < kStopsAfter) return false;
    set(0.0, 0.0);
    return true;
  }
  std::string answer() {
    if (body_ != nullptr) {
      body_->with([this](const bridges::PortBank& bank) {
        bank.read<hal::WheelEncoders>([this](const hal::WheelEncoders& encoders) {
          left_mm_ = 1e3 * encoders.left_m;
          right_mm_ = 1e3 * encoders.right_m;
        });
      });
    }
    std::array<char, 80> text;
    const int size = std::snprintf(text.data(), text.size(), "E %ld %ld %ld %ld\n", std::lround(left_mm_),
                                   std::lround(right_mm_), std::lround(left_mm_s_), std::lround(right_mm_s_));
    return {text.data(), static_cast<std::size_t>(size)};
  }
  bool moves() const { return left_mm_s_ != 0.0 || right_mm_s_ != 0.0; }

 private:
  void set(double left_mm_s, double right_mm_s) {
    left_mm_s_ = left_mm_s;
    right_mm_s_ = right_mm_s;
    if (body_ == nullptr) return;
    body_->with(
        [&](const bridges::PortBank& bank) { bank.port<hal::WheelSpeeds>().set(1e-3 * left_mm_s, 1e-3 * right_mm_s); });
  }

  bridges::SharedPorts* body_;
  double left_mm_ = 0.0, right_mm_ = 0.0, left_mm_s_ = 0.0, right_mm_s_ = 0.0;
  TimeNs told_ns_ = 0, turned_ns_ = 0;
};

hal::Status run(const bridges::EmulatorRequest& request, bridges::SharedPorts* body, const std::atomic<bool>& stop) {
  if (!request.faults.empty())
    return hal::Error{"an emulated buggy shows no faults, so not '" + request.faults[0] + "'"};
  std::unique_ptr<bridges::EventLog> log;
  if (!request.log_file.empty()) {
    auto opened = bridges::EventLog::open(request.log_file);
    if (!opened.ok()) return opened.error();
    log = std::move(opened).value();
  }
  auto port = bridges::SerialPort::open(request.link, "an emulated buggy", kBaud);
  if (!port.ok()) return port.error();
  bridges::SerialPort& line = *port.value();
  if (request.ready) request.ready("buggy on " + line.path() + ": connect with --link serial:" + line.path() + "@9600");
  Buggy buggy(body);
  std::string heard;
  int left = 0, right = 0;
  while (!stop.load(std::memory_order_relaxed)) {
    pollfd waiting{line.descriptor(), POLLIN, 0};
    ::poll(&waiting, 1, static_cast<int>(kTurn / kNsPerMs));
    std::array<std::uint8_t, 256> bytes;
    const auto count = line.read(bytes);
    if (!count.ok()) return count.error();
    const TimeNs now = bridges::monotonic_ns();
    for (std::size_t i = 0; i < count.value(); ++i) {
      if (bytes[i] != '\n') {
        if (heard.size() < 64) heard += static_cast<char>(bytes[i]);
        continue;
      }
      int l = 0, r = 0;
      if (std::sscanf(heard.c_str(), "V %d %d", &l, &r) == 2) {
        buggy.command(l, r, now);
        if (log && (l != left || r != right)) log->write(now, "wheels", {{"left", l}, {"right", r}});
        left = l;
        right = r;
        const std::string answer = buggy.answer();
        line.write({reinterpret_cast<const std::uint8_t*>(answer.data()), answer.size()});
      }
      heard.clear();
    }
    if (buggy.turn(now)) {
      left = right = 0;
      if (log) log->write(now, "stopped by itself", {});
    }
  }
  return {};
}

struct NoOptions {
  void describe(hal::ParamVisitor&) {}
};

const bridges::EmulatorType kEmulator{.name = kName,
                                      .kind = kName,
                                      .summary = "A toy robot behind a serial line: pty:NAME, serial:DEVICE@9600.",
                                      .puppet = "<buggy_puppet library=\"libbuggy\" …>",
                                      .needs = &bridges::port_types_of<hal::WheelSpeeds, hal::WheelEncoders>,
                                      .ports = &bridges::port_types_of<hal::WheelSpeeds, hal::WheelEncoders>,
                                      .read = &bridges::read_options<NoOptions>,
                                      .run = &run};

}  // namespace

void register_emulator(hal::Registrar& registrar) {
  registrar.add(kEmulator);
}

}  // namespace buggy
