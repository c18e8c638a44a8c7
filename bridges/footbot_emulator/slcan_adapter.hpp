// A CAN adapter on a serial line that speaks slcan, the text protocol of the LAWICEL adapters: one command a line,
// ended by CR; answers end with CR, refusals are BEL.
//
//   Sn        bit rate: 8 is 1 Mbit/s, which the modules speak    O, L, C     open, only listen, close
//   tIIInDD…  a frame: identifier, length, bytes, all hex          V, v, N, F  version, serial number, flags
#pragma once
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "bridges/emulation/event_log.hpp"
#include "bridges/footbot_emulator/message.hpp"

namespace tandem::bridges::footbot_emulator {

/// The adapter alone, in explicit time, between the bytes of its serial line and the frames of its bus.
class SlcanAdapter {
 public:
  explicit SlcanAdapter(EventSink sink) : sink_(std::move(sink)) {}

  /// Takes in what the host wrote. Frames that it wants on the bus are added to `to_bus`.
  void receive(std::span<const std::uint8_t> bytes, hal::TimeNs now, std::vector<Frame>& to_bus);
  /// A frame has passed on the bus: the host is told while the channel is open.
  void show(const Frame& frame, hal::TimeNs now);
  /// What is to be written to the host.
  std::string take_output() { return std::exchange(output_, {}); }

  bool open() const noexcept { return channel_ != Channel::Closed; }

 private:
  enum class Channel : std::uint8_t { Closed, Open, Listening };

  void obey(std::string_view line, hal::TimeNs now, std::vector<Frame>& to_bus);
  bool obey_setting(std::string_view line, hal::TimeNs now);
  bool open_channel(Channel channel, hal::TimeNs now);
  bool send_frame(std::string_view line, hal::TimeNs now, std::vector<Frame>& to_bus);
  void answer(std::string_view text) { output_ += std::string(text) + '\r'; }
  /// The bus is heard: the bit rate is the modules' own.
  bool hears() const noexcept { return rate_ == '8'; }

  EventSink sink_;
  std::string line_;
  std::string output_;
  Channel channel_ = Channel::Closed;
  char rate_ = 0;  // as in the command; 0: none yet
  bool stamps_ = false;
  bool bus_errors_ = false;  // flag, until it is read
};

}  // namespace tandem::bridges::footbot_emulator
