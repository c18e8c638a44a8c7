// Range-and-bearing: messages heard from the robots in range, with where they came from.
#include "hal/device/range_and_bearing.hpp"

#include "core/device/sight.hpp"
#include "core/device/types.hpp"
#include "core/random/random.hpp"

namespace tandem::core {
namespace {

bool has_rab(const hal::DataSheet& sheet) {
  return sheet.rab_range_m > 0.0;
}

struct IdealHearing {
  std::string medium;
  bool check_occlusions = true;
  bool show_rays = false;
  void describe(hal::ParamVisitor& v) {
    v.text("medium", medium, "Id of the range-and-bearing medium.");
    v.flag("check_occlusions", check_occlusions, "Boxes and cylinders block messages.");
    v.flag("show_rays", show_rays, "Draw the lines in a view; no effect on readings.");
  }
};

template <int kPerMille>
struct Hearing : IdealHearing {
  double noise_std_dev_m = kPerMille * 1e-3;
  double packet_drop_prob = kPerMille * 1e-3;
  void describe(hal::ParamVisitor& v) {
    IdealHearing::describe(v);
    v.number("noise_std_dev", noise_std_dev_m, hal::unit::m, hal::kNotNegative,
             "Standard deviation of the sender's apparent place, along x and along y.");
    v.number("packet_drop_prob", packet_drop_prob, hal::unit::none, {0.0, 1.0}, "Probability that a message is lost.");
  }
};

class RabSensor final : public Sensor {
 public:
  explicit RabSensor(const Hearing<0>& options) : options_(options) {}

  void sense(const DeviceContext& context, void* ports) noexcept override {
    auto* receivers = static_cast<hal::RangeAndBearing*>(ports);
    double farthest_m = 0.0;
    for (const RobotGroup& group : context.stores.groups) farthest_m = std::max(farthest_m, group.rab_range_m);
    for (std::size_t i = 0; i < context.block.used; ++i) {
      hal::RangeAndBearing& port = receivers[i];
      port.taken_ns = context.now_ns;
      port.validity = hal::Validity::Fresh;
      port.count = 0;
      port.dropped = 0;
      hear(context, context.block.first_row + i, farthest_m, port);
    }
  }

 private:
  void hear(const DeviceContext& context, std::size_t row, double farthest_m,
            hal::RangeAndBearing& port) const noexcept {
    const SpaceStores& stores = context.stores;
    const Bodies& b = stores.bodies;
    if (stores.broadcasts.empty()) return;
    const double x = b.x_m[row];
    const double y = b.y_m[row];
    const double height = context.group.sheet->rab_height_m + stores.base_m(row);
    stores.body_index.for_each_near(x, y, farthest_m, [&](const IndexEntry& o) {
      const std::uint32_t other = o.row();
      const Broadcast& message = stores.broadcasts[other];
      if (message.sending == 0 || other == row) return;
      double wx = o.x_m - x;
      double wy = o.y_m - y;
      const double reach = static_cast<double>(message.range_m);
      if (wx * wx + wy * wy > reach * reach) return;
      // Boards of robots of one kind on level ground are equally high.
      const double other_height =
          b.motion.empty() ? height : stores.sheet_of_row(other).rab_height_m + stores.base_m(other);
      const double wz = other_height - height;
      if (wx * wx + wy * wy + wz * wz > reach * reach) return;
      if (options_.check_occlusions && !in_sight(stores, x, y, height, o.x_m, o.y_m, other_height)) return;
      if (options_.packet_drop_prob > 0.0 && lost(context, b.entity[row], b.entity[other])) return;
      if (options_.noise_std_dev_m > 0.0) {
        const auto bits =
            draw(context.seed, b.entity[row], Stream::RabNoise, context.tick, b.entity[other] & 0xFFFFFFU);
        const auto noise = to_normal(bits[0], bits[1]);
        wx += options_.noise_std_dev_m * noise[0];
        wy += options_.noise_std_dev_m * noise[1];
      }
      const double bx = b.cos_h[row] * wx + b.sin_h[row] * wy;
      const double by = b.cos_h[row] * wy - b.sin_h[row] * wx;
      const double flat2 = wx * wx + wy * wy;
      port.insert(static_cast<float>(std::sqrt(flat2 + wz * wz)), static_cast<float>(std::atan2(by, bx)),
                  wz == 0.0 ? 0.0F : static_cast<float>(std::atan2(wz, std::sqrt(flat2))), message.payload.data(),
                  message.size);
    });
  }

  bool lost(const DeviceContext& context, std::uint32_t receiver, std::uint32_t sender) const noexcept {
    const auto bits = draw(context.seed, receiver, Stream::RabLoss, context.tick, sender & 0xFFFFFFU);
    return to_unit(bits[0]) < options_.packet_drop_prob;
  }

  Hearing<0> options_;
};

template <class Options>
Recipe<Sensor> make_hearing(const Element& element, Problems& problems, const DeviceSetup&) {
  const auto read = read_options<Options>(element, problems);
  Hearing<0> options;
  options.check_occlusions = read.check_occlusions;
  if constexpr (requires { read.noise_std_dev_m; }) {
    options.noise_std_dev_m = read.noise_std_dev_m;
    options.packet_drop_prob = read.packet_drop_prob;
  }
  return [options](std::size_t) { return std::make_unique<RabSensor>(options); };
}

template <class Options>
DeviceType hearing_type(std::string_view implementation, std::string_view summary) {
  return sensor_type("range_and_bearing", implementation, summary, &has_rab, &make_hearing<Options>,
                     &describe_options<Options>);
}

// --- sending ---

struct IdealSending {
  std::string medium;
  void describe(hal::ParamVisitor& v) { v.text("medium", medium, "Id of the range-and-bearing medium."); }
};

template <int kPerMille>
struct Sending : IdealSending {
  double failure_prob = kPerMille * 1e-3;
  void describe(hal::ParamVisitor& v) {
    IdealSending::describe(v);
    v.number("failure_prob", failure_prob, hal::unit::none, {0.0, 1.0},
             "Probability that a broadcast is not sent at all.");
  }
};

class RabActuator final : public Actuator {
 public:
  explicit RabActuator(double failure_prob) : failure_prob_(failure_prob) {}

  void act(const DeviceContext& context, SpaceStores& stores, const void* ports) noexcept override {
    const auto* senders = static_cast<const hal::RangeAndBearingSend*>(ports);
    const auto most = static_cast<std::uint8_t>(std::min<std::size_t>(context.group.rab_payload, hal::kRabPayloadMax));
    for (std::size_t i = 0; i < context.block.used; ++i) {
      const std::size_t row = context.block.first_row + i;
      Broadcast& out = stores.broadcasts[row];
      const bool able = (stores.bodies.flags[row] & kAlive) != 0 && context.block.halted[i] == 0;
      out.sending = able && senders[i].sending && !fails(context, stores.bodies.entity[row]) ? 1 : 0;
      out.size = std::min(senders[i].size, most);
      out.payload = senders[i].payload;
      out.range_m = static_cast<float>(context.group.rab_range_m);
    }
  }

 private:
  bool fails(const DeviceContext& context, std::uint32_t entity) const noexcept {
    return failure_prob_ > 0.0 &&
           to_unit(draw(context.seed, entity, Stream::SendLoss, context.tick)[0]) < failure_prob_;
  }

  double failure_prob_;
};

template <class Options>
Recipe<Actuator> make_sending(const Element& element, Problems& problems, const DeviceSetup&) {
  const auto options = read_options<Options>(element, problems);
  double failure_prob = 0.0;
  if constexpr (requires { options.failure_prob; }) failure_prob = options.failure_prob;
  return [failure_prob](std::size_t) { return std::make_unique<RabActuator>(failure_prob); };
}

template <class Options>
DeviceType sending_type(std::string_view implementation, std::string_view summary) {
  return actuator_type("range_and_bearing", implementation, summary, &has_rab, &make_sending<Options>,
                       &describe_options<Options>);
}

}  // namespace

std::vector<DeviceType> range_and_bearing_types() {
  return {
      hearing_type<Hearing<0>>("default", "Messages in range and in sight; noise and loss where asked for."),
      hearing_type<IdealHearing>("ideal", "Messages in range and in sight."),
      hearing_type<Hearing<10>>("noisy", "Messages in range and in sight, some lost, places uncertain."),
      hearing_type<Hearing<0>>("medium", "ARGoS' name for the default."),
      sending_type<Sending<0>>("default",
                               "Broadcasts to the robots in range in the next tick; failures where asked for."),
      sending_type<IdealSending>("ideal", "Broadcasts to the robots in range in the next tick."),
      sending_type<Sending<10>>("noisy", "Broadcasts to the robots in range in the next tick, but for some failures.")};
}

}  // namespace tandem::core
