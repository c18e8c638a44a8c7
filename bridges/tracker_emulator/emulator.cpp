#include "bridges/tracker_emulator/emulator.hpp"

#include <algorithm>
#include <arpa/inet.h>
#include <array>
#include <charconv>
#include <cmath>
#include <cstring>
#include <memory>
#include <netinet/in.h>
#include <numbers>
#include <optional>
#include <sstream>
#include <sys/socket.h>
#include <time.h>
#include <unistd.h>

#include "bridges/lcm/lcm_link.hpp"
#include "bridges/tracker_emulator/faults.hpp"
#include "bridges/tracker_emulator/frame_sender.hpp"
#include "bridges/tracker_emulator/messages.hpp"
#include "bridges/tracker_emulator/pose_log.hpp"
#include "bridges/tracker_emulator/register.hpp"

namespace tandem::bridges::tracker_emulator {
namespace {

using hal::TimeNs;

constexpr TimeNs kTurnNs = 5 * hal::kNsPerMs;
constexpr TimeNs kHeldBackNs = 500 * hal::kNsPerMs;        // by the fault `late`
constexpr TimeNs kOwnEpochNs = 1'234'567 * hal::kNsPerMs;  // a clock of its own shows this much more

TimeNs unix_ns() {
  timespec t{};
  ::clock_gettime(CLOCK_REALTIME, &t);
  return static_cast<TimeNs>(t.tv_sec) * hal::kNsPerSecond + t.tv_nsec;
}

class UdpSender final : public Sender {
 public:
  UdpSender(int socket, const sockaddr_in& to) : socket_(socket), to_(to) {}
  ~UdpSender() override { ::close(socket_); }
  void send(const std::vector<std::byte>& message) override {
    (void)::sendto(socket_, message.data(), message.size(), 0, reinterpret_cast<const sockaddr*>(&to_), sizeof to_);
  }

 private:
  int socket_;
  sockaddr_in to_;
};

class LcmSender final : public Sender {
 public:
  LcmSender(std::shared_ptr<lcm_bus::LcmLink> link, std::string channel)
      : link_(std::move(link)), channel_(std::move(channel)) {}
  void send(const std::vector<std::byte>& message) override { link_->publish(channel_, message); }

 private:
  std::shared_ptr<lcm_bus::LcmLink> link_;
  std::string channel_;
};

hal::Result<std::unique_ptr<Sender>> open_udp(const std::string& endpoint) {
  const std::size_t colon = endpoint.rfind(':');
  sockaddr_in to{};
  to.sin_family = AF_INET;
  unsigned port = 0;
  const std::string address = endpoint.substr(0, colon);
  const char* const end = endpoint.data() + endpoint.size();
  const bool good = colon != std::string::npos && ::inet_pton(AF_INET, address.c_str(), &to.sin_addr) == 1 &&
                    std::from_chars(endpoint.data() + colon + 1, end, port).ptr == end && port > 0 && port < 65536;
  if (!good) return hal::Error{"'udp:" + endpoint + "' is no link of a tracker; write udp:127.0.0.1:7700"};
  to.sin_port = htons(static_cast<std::uint16_t>(port));
  const int socket = ::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  if (socket < 0) return hal::Error{std::string("no socket can be made: ") + std::strerror(errno)};
  return std::unique_ptr<Sender>(std::make_unique<UdpSender>(socket, to));
}

hal::Result<std::unique_ptr<Sender>> open_sender(const Options& options) {
  if (options.link.starts_with("udp:")) return open_udp(options.link.substr(4));
  if (sends_frames(options.link)) return open_frame_sender(options.link);
  if (!options.link.starts_with("lcm:"))
    return hal::Error{"'" + options.link +
                      "' is no link of a tracker; write udp:ADDRESS:PORT, lcm:URL, pipe:FILE or folder:FOLDER"};
  auto link = lcm_bus::LcmLink::open(options.link.substr(4));
  if (!link.ok()) return link.error();
  return std::unique_ptr<Sender>(std::make_unique<LcmSender>(link.value(), options.channel));
}

/// Of one that sends frames.
struct Camera {
  Lens lens;
  Artist artist;
  std::vector<apriltag::Pattern> patterns;  // of what it sees
};

hal::Result<std::unique_ptr<Camera>> make_camera(const Options& options) {
  if (options.camera.empty())
    return hal::Error{"frames are taken by a camera: name its file with --camera, as `tandem calibrate` makes it"};
  const auto lens = read_lens(options.camera);
  if (!lens.ok()) return lens.error();
  std::vector<apriltag::Pattern> patterns;
  for (const auto& [name, log] : options.sees) {
    std::size_t id = 0;
    const char* const end = name.data() + name.size();
    if (std::from_chars(name.data(), end, id).ptr != end)
      return hal::Error{"--sees: '" + name + "' is no number of a tag, as frames need it"};
    auto pattern = apriltag::pattern(options.family, id);
    if (!pattern.ok()) return hal::Error{"--sees: " + pattern.error().message};
    patterns.push_back(std::move(pattern).value());
  }
  return std::make_unique<Camera>(
      Camera{lens.value(), Artist(lens.value(), options.picture, options.seed), std::move(patterns)});
}

class TrackerServer final : public Server {
 public:
  /// `camera`: of one that sends frames; else null.
  TrackerServer(const Options& options, std::unique_ptr<Sender> sender, EventSink tell, std::vector<Fault> faults,
                std::unique_ptr<Camera> camera)
      : Server(std::move(tell)),
        options_(options),
        sender_(std::move(sender)),
        faults_(std::move(faults), options.seed + 1),
        camera_(std::move(camera)),
        chance_(options.seed) {
    for (const auto& [name, path] : options.sees) things_.push_back({name, PoseLog(path)});
  }

 private:
  struct Thing {
    std::string name;
    PoseLog log;
  };
  struct Outgoing {
    TimeNs at;
    std::vector<std::byte> message;
  };

  hal::Status begin() override;
  hal::Status turn(TimeNs now) override;
  TimeNs next_wake(TimeNs now) const override { return now + kTurnNs; }
  void end(TimeNs now, const hal::Status& served) override;
  void note_drive(TimeNs now);
  double normal(double sd);
  void expose(TimeNs at);
  void photograph(TimeNs at);
  void hand_out(TimeNs at, std::vector<std::byte> message);
  std::int64_t stamp(TimeNs at) const;
  std::vector<std::byte> message_of(const Exposure& exposure) const;

  const Options& options_;
  std::unique_ptr<Sender> sender_;
  FaultPlan faults_;
  std::unique_ptr<Camera> camera_;
  Chance chance_;  // of the noise
  std::vector<Thing> things_;
  std::vector<Outgoing> outgoing_;
  TimeNs exposure_ns_ = 0;  // the next
  std::int64_t sightings_ = 0, messages_ = 0;
};

hal::Status TrackerServer::begin() {
  const TimeNs start = exposure_ns_ = monotonic_ns();
  faults_.begin(start);
  tell_(start, "start", {{"link", options_.link}, {"clock", options_.clock}, {"seed", options_.seed}});
  if (options_.ready) options_.ready("tracker sends to " + options_.link);
  return {};
}

void TrackerServer::end(TimeNs now, const hal::Status& /*served*/) {
  tell_(now, "end", {{"messages", messages_}, {"sightings", sightings_}});
}

hal::Status TrackerServer::turn(TimeNs now) {
  const auto period_ns = static_cast<TimeNs>(1e9 / options_.rate_hz);
  const auto delay_ns = static_cast<TimeNs>(options_.delay_s * 1e9);
  for (Thing& thing : things_) thing.log.follow();
  note_drive(now);
  (void)apply_changes(faults_, now, tell_, [](const FaultPlan::Change&) { return hal::Status{}; });
  // A camera that is behind leaves frames out.
  while (camera_ && exposure_ns_ + delay_ns + period_ns <= now) exposure_ns_ += period_ns;
  for (; exposure_ns_ + delay_ns <= now; exposure_ns_ += period_ns)
    camera_ ? photograph(exposure_ns_) : expose(exposure_ns_);
  for (const Outgoing& out : outgoing_) {
    if (out.at <= now) sender_->send(out.message);
  }
  std::erase_if(outgoing_, [&](const Outgoing& out) { return out.at <= now; });
  return {};
}

void TrackerServer::note_drive(TimeNs now) {
  std::optional<TimeNs> first;
  for (const Thing& thing : things_) {
    const auto moved = thing.log.first_moved_ns();
    if (moved) first = std::min(first.value_or(*moved), *moved);
  }
  if (first) faults_.driven(*first, now);
}

/// Box and Muller's way.
double TrackerServer::normal(double sd) {
  const auto uniform = [&] { return (static_cast<double>(chance_.draw() >> 11U) + 0.5) * 0x1p-53; };
  const double length = std::sqrt(-2.0 * std::log(uniform()));
  return sd * length * std::cos(2.0 * std::numbers::pi * uniform());
}

void TrackerServer::expose(TimeNs at) {
  Exposure exposure;
  exposure.stamp_ns = stamp(at);
  if (options_.tells_noise) {
    exposure.sd_m = options_.noise_m;
    exposure.sd_rad = options_.noise_rad;
  }
  if (faults_.active(FaultKind::Gap, at)) return;
  const double shift_m = faults_.shift_m(at);
  const double side = faults_.active(FaultKind::Mirror, at) ? -1.0 : 1.0;
  for (const Thing& thing : things_) {
    const auto pose = thing.log.at(at);
    if (!pose || faults_.happens(FaultKind::Lose, at)) continue;
    Seen seen{
        thing.name, pose->x_m + shift_m + normal(options_.noise_m), side * (pose->y_m + normal(options_.noise_m)), {}};
    const double heading_rad = side * (pose->heading_rad + normal(options_.noise_rad));
    if (options_.sees_headings) seen.heading_rad = std::remainder(heading_rad, 2.0 * std::numbers::pi);
    exposure.seen.push_back(seen);
  }
  if (exposure.seen.empty()) return;
  if (exposure.seen.size() > 1 && faults_.happens(FaultKind::Swap, at))
    std::swap(exposure.seen[0].name, exposure.seen[1].name);
  sightings_ += static_cast<std::int64_t>(exposure.seen.size());
  ++messages_;
  hand_out(at, message_of(exposure));
}

/// Everything that it sees, as a picture, whatever goes wrong with it.
void TrackerServer::photograph(TimeNs at) {
  if (faults_.active(FaultKind::Gap, at)) return;
  const double shift_m = faults_.shift_m(at);
  std::vector<PlacedTag> tags;
  for (std::size_t i = 0; i < things_.size(); ++i) {
    const auto pose = things_[i].log.at(at);
    if (!pose || faults_.happens(FaultKind::Lose, at)) continue;
    PlacedTag tag{
        camera_->patterns[i], options_.tag_size_m, {pose->x_m + shift_m, pose->y_m, options_.tag_height_m}, {}};
    // The upper edge points forward.
    const double c = std::cos(pose->heading_rad), s = std::sin(pose->heading_rad);
    tag.axes_W << s, c, 0.0, -c, s, 0.0, 0.0, 0.0, 1.0;
    tags.push_back(std::move(tag));
  }
  if (tags.size() > 1 && faults_.happens(FaultKind::Swap, at)) std::swap(tags[0].pattern, tags[1].pattern);
  camera_->artist.set_mirrored(faults_.active(FaultKind::Mirror, at));
  sightings_ += static_cast<std::int64_t>(tags.size());
  ++messages_;
  hand_out(at, frame_message(camera_->lens.width, camera_->lens.height, stamp(at), camera_->artist.draw(tags)));
}

void TrackerServer::hand_out(TimeNs at, std::vector<std::byte> message) {
  if (faults_.happens(FaultKind::Garbage, at)) message.resize(message.size() / 2);
  const TimeNs leaves =
      at + static_cast<TimeNs>(options_.delay_s * 1e9) + (faults_.happens(FaultKind::Late, at) ? kHeldBackNs : 0);
  if (faults_.happens(FaultKind::Double, at)) outgoing_.push_back({leaves, message});
  outgoing_.push_back({leaves, std::move(message)});
}

std::int64_t TrackerServer::stamp(TimeNs at) const {
  std::int64_t shown = at;
  if (options_.clock == "unix") shown += unix_ns() - monotonic_ns();
  if (options_.clock == "own") shown += kOwnEpochNs;
  return shown + faults_.jump_ns(at);
}

std::vector<std::byte> TrackerServer::message_of(const Exposure& exposure) const {
  if (options_.link.starts_with("lcm:")) return lcm_message(exposure);
  return options_.form == "json" ? json_message(exposure) : compact_message(exposure);
}

}  // namespace

hal::Status run(const Options& options, const std::atomic<bool>& stop) {
  if (options.sees.empty()) return hal::Error{"it sees nothing: name robots and their logs with --sees fb0=fb0.log"};
  auto sender = open_sender(options);
  if (!sender.ok()) return sender.error();
  std::unique_ptr<Camera> camera;
  if (sends_frames(options.link)) {
    auto made = make_camera(options);
    if (!made.ok()) return made.error();
    camera = std::move(made).value();
  }
  return serve_with(options, kFaults, stop, [&](const EventSink& events, std::vector<Fault> faults) {
    return TrackerServer(options, std::move(sender).value(), events, std::move(faults), std::move(camera));
  });
}

namespace {

struct Own {
  Options o;
  std::string sees;
  void describe(hal::ParamVisitor& v) {
    static constexpr std::array<std::string_view, 3> kClocks = {"own", "unix", "monotonic"};
    static constexpr std::array<std::string_view, 2> kForms = {"compact", "json"};
    v.text("sees", sees, "What it sees, as NAME=LOG, separated by spaces: logs of emulated robots that tell poses.");
    v.number("rate", o.rate_hz, hal::unit::hz, {0.1, 1000.0}, "Exposures a second.");
    v.number("delay", o.delay_s, hal::unit::s, {0.0, 10.0}, "From exposure to sending.");
    v.number("noise", o.noise_m, hal::unit::m, {0.0, 10.0}, "Of x and of y: standard deviation.");
    v.number("heading_noise", o.noise_rad, hal::unit::rad, {0.0, 3.0}, "Of headings: standard deviation.");
    v.flag("tells_noise", o.tells_noise, "Whether its messages say these.");
    v.flag("headings", o.sees_headings, "Whether it sees headings.");
    v.choice("clock", o.clock, kClocks, "Of its stamps: one of its own, the date, CLOCK_MONOTONIC.");
    v.choice("form", o.form, kForms, "Of datagrams.");
    v.text("channel", o.channel, "Of LCM messages.");
    v.text("camera", o.camera, "Of frames: the file of the camera that takes them.");
    v.choice("family", o.family, apriltag::family_names(), "Of frames: of the tags.");
    v.number("tag_size", o.tag_size_m, hal::unit::m, {0.001, 10.0}, "Of frames: side of a tag's black square.");
    v.number("tag_height", o.tag_height_m, hal::unit::m, {0.0, 10.0}, "Of frames: of tags above the floor.");
    v.number("blur", o.picture.blur_px, hal::unit::none, {0.01, 10.0}, "Of frames: in pixels, standard deviation.");
    v.number("grain", o.picture.noise, hal::unit::none, {0.0, 100.0},
             "Of frames: noise of each pixel, of 255, standard deviation.");
  }
};

hal::Status run_type(const EmulatorRequest& request, SharedPorts* ports, const std::atomic<bool>& stop) {
  if (ports != nullptr) return hal::Error{"a tracker has no body"};
  Options options;
  if (request.options != nullptr) {
    const Own& own = *static_cast<const Own*>(request.options.get());
    options = own.o;
    std::istringstream words(own.sees);
    for (std::string word; words >> word;) {
      const std::size_t equals = word.find('=');
      if (equals == std::string::npos || equals == 0)
        return hal::Error{"--sees: '" + word + "' is not of the form NAME=LOG"};
      if (equals > 16) return hal::Error{"--sees: the name in '" + word + "' is longer than 16 characters"};
      options.sees.emplace_back(word.substr(0, equals), word.substr(equals + 1));
    }
  }
  apply(request, options);
  options.ready = request.ready;
  return run(options, stop);
}

std::vector<const hal::PortType*> no_ports() {
  return {};
}

const EmulatorType kType{
    .name = "tracker",
    .kind = {},
    .summary = "A tracker that sees emulated robots: udp:ADDRESS:PORT, lcm:URL; a camera: pipe:FILE, folder:FOLDER.",
    .puppet = {},
    .needs = &no_ports,
    .ports = &no_ports,
    .faults = [] { return kFaults.manual(); },
    .read = &read_options<Own>,
    .run = &run_type};

}  // namespace

void register_emulator(hal::Registrar& registrar) {
  registrar.add(kType);
}

}  // namespace tandem::bridges::tracker_emulator
