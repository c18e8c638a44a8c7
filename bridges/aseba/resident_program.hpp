// A program of the hub's own in a node of a robot: sent there, started, watched, and sent again when it is gone.
//
//   Unknown --its mailbox is read: the signature, and the beat goes on--> Running
//   Unknown, Running --another signature, or the beat stands--> Loading: the program is sent and started
//   Loading --the signature, and the beat goes on--> Running
//
// Hub and program talk by the mailbox: words behind the node's named variables, written and read like those.
#pragma once
#include <cstdint>
#include <vector>

#include "bridges/aseba/network.hpp"

namespace tandem::bridges::aseba {

/// The first words of every mailbox, all written by the program.
namespace mail_head {
inline constexpr std::uint16_t kSignature = 0;  ///< of the program
inline constexpr std::uint16_t kBeat = 1;       ///< grows with each of its turns
inline constexpr std::uint16_t kLapses = 2;     ///< times that it stopped the robot, for it heard nothing of the hub
}  // namespace mail_head

struct NodeProgram {
  std::vector<std::uint16_t> words;
  std::uint16_t mailbox = 0;   ///< address of its first word
  std::int16_t signature = 0;  ///< of these words; never 0
};

/// 15 bits that differ between programs, never 0. Of the words with a place-holder in the form of a signature in them.
std::int16_t signature_of(const std::vector<std::uint16_t>& words) noexcept;
inline constexpr std::int16_t kSignatureToCome = 0x4000;

/// Number of a name in a node's list of events or functions; -1: it is not there.
int number_of(const std::vector<std::string>& names, std::string_view name) noexcept;

class ResidentProgram {
 public:
  enum class State : std::uint8_t { Unknown, Loading, Running };
  struct Timing {
    hal::TimeNs beat_ns = 20 * hal::kNsPerMs;  ///< of the program
    hal::TimeNs settle_ns = 0;                 ///< it must have run for so long since its start
    std::uint16_t told = 3;                    ///< words of the mailbox that are read
  };
  /// The contents of a mailbox that was read.
  struct Heard {
    hal::TimeNs taken_ns = 0;  ///< when; 0: nothing new was read, and nothing below is set
    bool ours = false;         ///< its signature
    bool began = false;        ///< it runs from now on
    bool lapsed = false;       ///< it has stopped the robot since the last time
    bool gone = false;         ///< it ran, and does not run any more
    bool absent = false;       ///< it is to be sent
  };

  /// For a node that was described just now, whatever it runs.
  void begin(NodeProgram program, const Timing& timing);

  /// Looks at a mailbox that was read since the last look.
  Heard hear(const Node& node) noexcept;
  /// Sends the program and starts it. The node begins with a reset, and what that does is the node's own affair.
  void load(Network& network, const Node& node, hal::TimeNs now) noexcept;
  /// Where it does not run: asks for the mailbox, and sends the program again in time. @returns whether there is
  /// something to send.
  bool pursue(Network& network, const Node& node, hal::TimeNs now) noexcept;

  const NodeProgram& program() const noexcept { return program_; }
  State state() const noexcept { return state_; }
  bool running() const noexcept { return state_ == State::Running; }
  /// It ran, and nothing shows that it stopped.
  bool ran() const noexcept { return ran_; }
  hal::TimeNs heard_ns() const noexcept { return heard_ns_; }
  std::uint64_t loads() const noexcept { return loads_; }  ///< since `begin`

 private:
  std::int16_t mail(const Node& node, std::uint16_t word) const noexcept {
    return node.value(program_.mailbox + std::size_t{word});
  }

  NodeProgram program_;
  Timing timing_;
  State state_ = State::Unknown;
  bool ran_ = false, beat_known_ = false;
  std::int16_t beat_ = 0, lapses_ = 0;
  hal::TimeNs heard_ns_ = 0, beat_ns_ = 0, loaded_ns_ = 0, looked_ns_ = 0;
  std::uint64_t loads_ = 0;
};

}  // namespace tandem::bridges::aseba
