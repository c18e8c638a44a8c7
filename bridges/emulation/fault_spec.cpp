#include "bridges/emulation/fault_spec.hpp"

#include <cmath>

#include "hal/unit.hpp"

namespace tandem::bridges {

hal::TimeNs FaultSpec::until(hal::TimeNs otherwise) const noexcept {
  if (!duration && otherwise >= kEndless) return kEndless;
  return from() + duration.value_or(otherwise);
}

hal::Result<hal::TimeNs> parse_time(std::string_view text) {
  const auto seconds = hal::parse_quantity(text, hal::unit::s);
  if (!seconds.ok()) return seconds.error();
  if (seconds.value() < 0.0) return hal::Error{"'" + std::string(text) + "' is before the start"};
  const double ns = seconds.value() * 1e9;
  return ns < static_cast<double>(kEndless) ? static_cast<hal::TimeNs>(std::llround(ns)) : kEndless;
}

hal::Result<hal::TimeNs> parse_jump(std::string_view text) {
  const bool back = text.starts_with('-');
  const std::string_view rest = back ? text.substr(1) : text;
  const double factor = rest.ends_with('h') ? 3600.0 : 1.0;
  const auto time = hal::parse_quantity(factor > 1.0 ? rest.substr(0, rest.size() - 1) : rest, hal::unit::s);
  if (!time.ok()) return time.error();
  const double seconds = factor * time.value();
  if (!(std::fabs(seconds) <= 1e9)) return hal::Error{"a clock jumps by less than 30 years"};
  return static_cast<hal::TimeNs>(std::llround((back ? -1e9 : 1e9) * seconds));
}

hal::Result<double> parse_probability(std::string_view text) {
  const auto probability = hal::parse_quantity(text, hal::unit::none);
  if (!probability.ok()) return probability.error();
  if (!(probability.value() >= 0.0 && probability.value() <= 1.0)) {
    return hal::Error{"a probability is from 0 to 1"};
  }
  return probability.value();
}

hal::Result<FaultSpec> split_fault(std::string_view text) {
  FaultSpec spec;
  const std::string_view head = text.substr(0, text.find('@'));
  spec.name = head.substr(0, head.find('='));
  if (head.size() > spec.name.size()) spec.value = head.substr(spec.name.size() + 1);
  if (head.size() == text.size()) return spec;
  constexpr std::string_view kDrive = "drive";
  std::string_view when = text.substr(head.size() + 1);
  spec.since_drive = when == kDrive || when.starts_with("drive+");
  if (when == kDrive) {
    spec.start = 0;
    return spec;
  }
  if (spec.since_drive) when.remove_prefix(kDrive.size() + 1);
  const std::size_t plus = when.find('+');
  const auto start = parse_time(when.substr(0, plus));
  if (!start.ok()) return hal::Error{start.error().message + "; a fault begins at a time, as @5s, or @drive+5s"};
  spec.start = start.value();
  if (plus == std::string_view::npos) return spec;
  const auto duration = parse_time(when.substr(plus + 1));
  if (!duration.ok()) return duration.error();
  spec.duration = duration.value();
  return spec;
}

std::uint64_t Chance::draw() noexcept {
  state_ += 0x9E3779B97F4A7C15ULL;
  std::uint64_t z = state_;
  z = (z ^ (z >> 30U)) * 0xBF58476D1CE4E5B9ULL;
  z = (z ^ (z >> 27U)) * 0x94D049BB133111EBULL;
  return z ^ (z >> 31U);
}

}  // namespace tandem::bridges
