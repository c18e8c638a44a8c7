// Range-and-bearing: short situated messages. The receiver learns the payload and where, relative to itself, the sender
// is.
#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <string>

#include "hal/elementary.hpp"
#include "hal/open_params.hpp"
#include "hal/port.hpp"

namespace tandem::hal {

inline constexpr std::size_t kRabPayloadMax =
    10;  ///< bytes; the foot-bot's. An e-puck sends 2 unless its file says otherwise
inline constexpr std::size_t kLongRabPayloadMax = 64;  ///< of the ports with more room

/// The range-and-bearing board.
struct RangeAndBearingPart {
  static constexpr std::string_view kName = "range_and_bearing";
  static constexpr std::string_view kDoc = "A board that sends messages to the robots in range.";
  double range_m = 0.0;      ///< between centres
  double height_m = 0.0;     ///< above the ground
  std::int64_t payload = 0;  ///< bytes of a message
  std::string source = {};

  void describe(ParamVisitor& v) {
    v.number("range", range_m, unit::m, {1e-9, 1e4}, "How far its messages reach, between the robots' axes.");
    v.number("height", height_m, unit::m, kNotNegative, "Above the ground.");
    v.integer("payload", payload, {0, static_cast<double>(kRabPayloadMax)}, "Bytes of a message.");
    v.text("source", source, "Where these figures come from.");
  }
  void attributes(ParamVisitor& v) {
    v.number("rab_range", range_m, unit::m, {0.0, 1e4}, "Reach of range-and-bearing.");
    const std::size_t most = in_argos_file(v) ? kLongRabPayloadMax : kRabPayloadMax;
    v.integer("rab_data_size", payload, {0, static_cast<double>(most)}, "Bytes of a range-and-bearing message.");
  }
  /// A board.
  void appear(const RobotKind& kind, Appearance& look) const {
    const double r = kind.body.radius_m;
    look.links.push_back(round_piece("cylinder", "#1f6b45", 0.0, 0.0, 0.6 * r, height_m - 0.05 * r, height_m));
  }
};

/// Bytes of a message of the robot's board that a port with so much room holds.
inline std::size_t message_bytes(const RobotKind& kind, std::size_t room) noexcept {
  const auto* const board = kind.part<RangeAndBearingPart>();
  return board == nullptr ? 0 : std::min(static_cast<std::size_t>(board->payload), room);
}

/// Message of up to `kBytes` bytes to broadcast in this tick. Safe value: nothing.
template <std::size_t kBytes>
struct SentMessage : Command {
  static constexpr std::string_view kDoc = "The message broadcast to robots in range.";
  static constexpr bool kAnyValueIsSafe = true;  // who sends it looks at `size`

  bool sending = false;
  std::uint8_t size = 0;
  std::array<std::uint8_t, kBytes> payload{};

  /// Broadcasts one byte.
  void say(std::uint8_t byte) noexcept {
    sending = true;
    size = 1;
    payload[0] = byte;
  }
  void describe(FieldList& f) const {
    f.add("sending", sending, unit::none, Frame::None, Fusion::Real, "broadcast in this tick");
    f.add("size", size, unit::none, Frame::None, Fusion::Real, "bytes of payload in use");
    f.add("payload", payload, unit::none, Frame::None, Fusion::Real, "the bytes").used_by = "size";
  }
};

struct RangeAndBearingSend : SentMessage<kRabPayloadMax> {
  static constexpr std::string_view kName = "range_and_bearing";
};

/// The same for messages that are longer than those of real boards.
struct RangeAndBearingLongSend : SentMessage<kLongRabPayloadMax> {
  static constexpr std::string_view kName = "range_and_bearing_many";
  static constexpr std::string_view kGrows = RangeAndBearingSend::kName;
};

/// Messages received in this tick, nearest first; the farthest are dropped when there are more than `kMessages`.
template <std::size_t kMessages, std::size_t kBytes>
struct HeardMessages : Reading {
  static constexpr std::string_view kDoc = "Messages received, with range and bearing of each sender.";
  static constexpr std::size_t kCapacity = kMessages;
  static constexpr std::size_t kPayload = kBytes;

  std::uint32_t count = 0;
  std::uint32_t dropped = 0;  ///< received beyond the capacity in this tick
  std::array<float, kCapacity> range_m{};
  std::array<float, kCapacity> bearing_rad{};    ///< counter-clockwise from forward
  std::array<float, kCapacity> elevation_rad{};  ///< upwards from the horizontal
  std::array<std::uint8_t, kCapacity> size{};
  std::array<std::uint8_t, kCapacity * kBytes> payload{};

  const std::uint8_t* message(std::size_t i) const noexcept { return payload.data() + i * kBytes; }

  /// Inserts in order of range; drops the farthest when full.
  void insert(float range, float bearing, float elevation, const std::uint8_t* bytes, std::uint8_t n) noexcept {
    if (count == kCapacity) {
      ++dropped;
      if (range >= range_m[kCapacity - 1]) return;
    } else {
      ++count;
    }
    std::size_t at = count - 1;
    for (; at > 0 && range_m[at - 1] > range; --at) copy_entry(at, at - 1);
    range_m[at] = range;
    bearing_rad[at] = bearing;
    elevation_rad[at] = elevation;
    size[at] = n;
    std::copy_n(bytes, std::min<std::size_t>(n, kBytes), payload.data() + at * kBytes);
  }
  /// Adds the messages of `other` that are not there: the same bytes from a place within kSamePlace_m are the same
  /// message.
  void merge(const HeardMessages& other) noexcept {
    const HeardMessages own = *this;
    for (std::size_t i = 0; i < other.count; ++i) {
      if (own.has(other, i)) continue;
      insert(other.range_m[i], other.bearing_rad[i], other.elevation_rad[i], other.message(i), other.size[i]);
    }
    dropped += other.dropped;
  }
  void describe(FieldList& f) const {
    f.add("count", count, unit::none, Frame::None, Fusion::Union, "messages received");
    f.add("dropped", dropped, unit::none, Frame::None, Fusion::Union, "messages beyond the capacity");
    f.add("range", range_m, unit::m, Frame::Body, Fusion::Union, "distance to the sender").used_by = "count";
    f.add("bearing", bearing_rad, unit::rad, Frame::Body, Fusion::Union, "counter-clockwise from forward").used_by =
        "count";
    f.add("elevation", elevation_rad, unit::rad, Frame::Body, Fusion::Union, "upwards").used_by = "count";
    f.add("size", size, unit::none, Frame::None, Fusion::Union, "bytes of payload").used_by = "count";
    f.add("payload", payload, unit::none, Frame::None, Fusion::Union,
          kBytes == kRabPayloadMax ? "10 bytes a message" : "64 bytes a message")
        .used_by = "count";
  }

 private:
  static constexpr float kSamePlace_m = 0.05F;  // two boards cannot be so near: an e-puck is 0.07 m wide

  bool has(const HeardMessages& other, std::size_t i) const noexcept {
    for (std::size_t k = 0; k < count; ++k) {
      if (size[k] != other.size[i] || !std::equal(message(k), message(k) + size[k], other.message(i))) continue;
      float apart2 = 0.0F;
      const std::array<float, 3> a = place(k);
      const std::array<float, 3> b = other.place(i);
      for (std::size_t axis = 0; axis < 3; ++axis) apart2 += (a[axis] - b[axis]) * (a[axis] - b[axis]);
      if (apart2 < kSamePlace_m * kSamePlace_m) return true;
    }
    return false;
  }
  std::array<float, 3> place(std::size_t i) const noexcept {
    const auto elevation = static_cast<double>(elevation_rad[i]);
    const auto bearing = static_cast<double>(bearing_rad[i]);
    const double flat_m = static_cast<double>(range_m[i]) * hal::cos(elevation);
    return {static_cast<float>(flat_m * hal::cos(bearing)), static_cast<float>(flat_m * hal::sin(bearing)),
            static_cast<float>(static_cast<double>(range_m[i]) * hal::sin(elevation))};
  }
  void copy_entry(std::size_t to, std::size_t from) noexcept {
    range_m[to] = range_m[from];
    bearing_rad[to] = bearing_rad[from];
    elevation_rad[to] = elevation_rad[from];
    size[to] = size[from];
    std::copy_n(payload.data() + from * kBytes, kBytes, payload.data() + to * kBytes);
  }
};

struct RangeAndBearing : HeardMessages<16, kRabPayloadMax> {
  static constexpr std::string_view kName = "range_and_bearing";
};

/// The same with room for more and longer messages than real boards take, for scripts and controllers of ARGoS.
struct RangeAndBearingMany : HeardMessages<256, kLongRabPayloadMax> {
  static constexpr std::string_view kName = "range_and_bearing_many";
  static constexpr std::string_view kGrows = RangeAndBearing::kName;
};

}  // namespace tandem::hal
