#include "bridges/tracker_emulator/register.hpp"

#include <array>
#include <sstream>

#include "bridges/emulation/emulator_type.hpp"
#include "bridges/tracker_emulator/emulator.hpp"
#include "bridges/tracker_emulator/faults.hpp"

namespace tandem::bridges::tracker_emulator {
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
