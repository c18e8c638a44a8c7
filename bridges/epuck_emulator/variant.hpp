// The firmwares that e-pucks are found with, and how they differ on the wire.
#pragma once
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "hal/result.hpp"

namespace tandem::bridges::epuck_emulator {

/// Btcom: EPFL's BTcom 2.0.0 of 2008. Gctronic: GCtronic's Asercom 1.2.2 of 2008. Webots: the firmware 1.5.3 of 2016
/// that Webots loads onto robots. Epuck2: GCtronic's Asercom2 of 2018 on the e-puck version 2.
enum class Variant : std::uint8_t { Btcom, Gctronic, Webots, Epuck2 };

struct VariantFacts {
  Variant variant;
  std::string_view name;             ///< as `--firmware` takes it
  std::string_view version;          ///< the answer to V, without "v,"
  std::string_view hardware;         ///< second line of that answer; empty: there is none
  std::int32_t speed_limit_steps_s;  ///< faster commands are clamped
  bool whole_ticks;                  ///< a motor step lasts a whole number of 0.1 ms
  bool wide_int;                     ///< `int` has 32 bits, not 16
  bool small_b_g;                    ///< b (battery) and g (gyro) are commands of their own
  bool link_test;                    ///< X
  bool i2c;                          ///< W, Y, Z
  bool stop_clears_all;              ///< S puts out body and front as well, and E answers 0 after it
  bool calibrated_binary;            ///< binary N has the offsets taken off
  int acceleration_zero;             ///< binary: what the accelerometer reads without a force
  int acceleration_zero_ascii;       ///< the same in a line
  std::size_t buffer_bytes;          ///< for one image; lines and answers have some more
};

const VariantFacts& facts_of(Variant variant) noexcept;

/// The variant called `name`; an error lists the known ones.
hal::Result<Variant> variant_from(std::string_view name);

}  // namespace tandem::bridges::epuck_emulator
