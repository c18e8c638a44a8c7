// Judges whether the robot at the end of a link is still the one that a hub has left moving there.
#pragma once
#include <cstdint>
#include <string>

#include "bridges/stop_messages.hpp"
#include "hal/time.hpp"

namespace tandem::bridges::guardian {

/// Whether this LINK text leads to a device in the file system.
bool is_terminal(const std::string& link);
/// The address by which this computer knows a robot from all others: of its Bluetooth radio, or the serial number of
/// its USB plug; "": it knows none.
std::string own_address(const RobotIdentity& identity);

enum class SameRobot : std::uint8_t { Unknown, Yes, No };

/// One robot's trace since its hub last spoke with it.
///
/// A robot that answers is the one that was left where its address says so; or where its line was never broken; or
/// where its link, as written, now leads to another device than before: somebody has made that name anew for it. A line
/// is broken when its device was taken away and made again, or when a network address was silent for more than 2 s.
/// Addresses on a bus (LCM, CAN) name the robot itself.
class RobotTrace {
 public:
  /// The hub speaks with it now, over what `robot` says; where that names no device, it was lost just now. Looks at the
  /// device.
  void begin(const StopMessages& robot);
  /// Looks at the device again; to be called before it is opened, and before an answer is believed.
  void look();
  /// It was tried to reach it, with or without success.
  void tried(bool reached, hal::TimeNs now) noexcept;

  /// The device that its link led to when it was looked at last; nothing: none, or the link is no terminal. What was
  /// heard over a link that leads elsewhere by now was said by another.
  const std::optional<std::string>& leads_to() const noexcept { return leads_to_; }
  /// Whether the robot that answers on its link is this one.
  bool proved() const;
  /// Whether another hub that has found `answers` has found this robot. Unknown: that hub does not know yet.
  SameRobot same_as(const StopMessages& answers) const;

 private:
  StopMessages robot_;
  std::optional<std::string> leads_to_;
  std::string node_;  // of the device, as it was; "": it has none, or none is known
  bool broken_ = false, renamed_ = false;
  hal::TimeNs silent_since_ns_ = 0;  // 0: it is not
};

}  // namespace tandem::bridges::guardian
