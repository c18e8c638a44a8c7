// Ports on one side, the Thymio's node on the other: finds the robot on the bus, gives it its program, and carries
// values both ways. The program is looked after as any of the hub's own (bridges/aseba/resident_program.hpp); it is
// used once every sensor has measured since its start.
//
// A reset clears the variables, and a robot may be reset at any time, by a loose battery or a foreign program:
// what sensors say is believed once the mailbox, read afterwards, shows that the program still runs.
#pragma once
#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "bridges/aseba/node_driver.hpp"
#include "bridges/aseba/resident_program.hpp"
#include "bridges/thymio/program.hpp"
#include "hal/device/buttons.hpp"
#include "hal/device/ring_sensors.hpp"
#include "hal/robot/thymio.hpp"

namespace tandem::bridges::thymio {

/// Every port class that a Thymio has: sensors first.
const std::vector<const hal::PortType*>& port_types();

/// Ports of one Thymio. Its motors tell speeds, not ways: what its wheels have rolled is added up from them.
class ThymioRobot final : public aseba::NodeRobot {
 public:
  explicit ThymioRobot(RobotSettings settings)
      : NodeRobot("Thymio", hal::thymio::kind(), std::move(settings), port_types()) {}
};

/// Options of one Thymio.
struct Calibration {
  std::uint8_t node = 0;                       ///< its number where several are on one link; 0: it is alone
  double full_m_s = 0.2;                       ///< its speed with the motors' target 500
  double white = 820.0;                        ///< what its ground sensors say of white ground
  hal::TimeNs alive_ns = 700 * hal::kNsPerMs;  ///< the robot stops by itself when it heard nothing for so long
};

struct WiringStatistics {
  std::uint64_t programs = 0;   ///< times that the program was sent
  std::uint64_t lapses = 0;     ///< times that the robot stopped by itself, as it was told to drive and heard no more
  std::uint64_t restarts = 0;   ///< times that its program was gone
  std::uint64_t not_shown = 0;  ///< LEDs and tones that had to be told again

  void describe(StatusVisitor& visitor) const;
};

/// Not thread-safe. Allocates when nodes come and go, else never. Functions without a comment are as in
/// bridges/footbot/wiring.hpp.
class Wiring : public aseba::NodeWiring {
 public:
  using Statistics = WiringStatistics;

  /// Both must outlive this. `observe`: nothing is ever written, and no program loaded.
  Wiring(const Calibration& calibration, aseba::Network& network, ThymioRobot& robot, bool observe = false);

  void note_demand() noexcept {}
  bool look() noexcept;
  std::string look_for_restarts() noexcept { return std::exchange(restarted_, {}); }
  /// Looks after the program.
  bool serve(hal::TimeNs now) noexcept;

  void fill(hal::TimeNs now) noexcept;
  void ask(hal::TimeNs now) noexcept;
  void command(bool drive, hal::TimeNs now) noexcept;
  void rest(hal::TimeNs now) noexcept;
  bool rests() const noexcept;

  bool complete() const noexcept { return running(); }
  bool lost_needed() const noexcept { return node_ != nullptr && node_->state == aseba::NodeState::Lost; }
  hal::TimeNs oldest_ns() const noexcept;
  std::string trouble() const { return needed_trouble(); }
  std::string needed_trouble() const;

  std::vector<aseba::NodeStatus> nodes() const;
  /// "thymio-II 1, firmware 14".
  void identify(bridges::RobotIdentity& identity) const;
  std::vector<aseba::RestMessage> rest_messages() const;
  const WiringStatistics& statistics() const noexcept { return statistics_; }

 private:
  /// A sensor's words; none where the robot has none, or they are not read.
  struct Source {
    const hal::PortType* type = nullptr;
    std::string_view name;
    std::uint16_t words = 0;
    std::uint16_t address = 0;
    bool bound = false;
  };
  /// What was written into the mailbox.
  struct Told {
    std::array<std::int16_t, 3> drive{};  // alive, left, right
    hal::TimeNs drive_ns = 0;             // 0: not since the program runs
  };
  /// Words that the program takes over once their number has changed.
  template <std::size_t n>
  struct Block {
    std::uint16_t number_word, done_word;
    std::array<std::int16_t, n> words{};
    std::int16_t number = 0;
    hal::TimeNs told_ns = 0;  // 0: not since the program runs
  };

  bool ready() const noexcept;
  bool running() const noexcept { return ready() && (observe_ || resident_.running()); }
  void bind(const aseba::Node& node);
  std::string trouble_of_node() const;
  const aseba::Node* find_node(std::string& trouble) const;
  void hear_program(hal::TimeNs now) noexcept;
  void now_runs(hal::TimeNs now) noexcept;
  void load_program(hal::TimeNs now) noexcept;
  void note_loads(std::uint64_t before) noexcept;
  std::int16_t mail(std::uint16_t word) const noexcept { return node_->value(program_.mailbox + std::size_t{word}); }
  hal::TimeNs mail_taken_ns() const noexcept { return node_->taken_ns(program_.mailbox, mailbox::kTold); }
  /// When words were taken that are believed; 0: never, or they are not.
  hal::TimeNs believed_ns(std::size_t address, std::size_t count = 1) const noexcept;
  void hold(hal::TimeNs until) noexcept;
  bool write_mail(std::uint16_t word, std::span<const std::int16_t> values) noexcept {
    return network_.write(node_->id, program_.mailbox + std::size_t{word}, values);
  }
  bool write_targets() noexcept;
  void write_drive(bool drive, hal::TimeNs now) noexcept;
  void write_leds(bool drive, hal::TimeNs now) noexcept;
  void write_tone(bool drive, hal::TimeNs now) noexcept;
  template <std::size_t n>
  void write_block(Block<n>& block, const std::array<std::int16_t, n>& words, hal::TimeNs now) noexcept;
  /// When the port's words were taken; 0: never, or they are not read.
  template <class Port>
  hal::TimeNs taken_ns() const noexcept;
  template <class Port>
  std::span<const std::int16_t> words_of() noexcept;
  template <class Port, class Fill>
  void fill_port(hal::TimeNs now, Fill&& fill) noexcept;
  void fill_wheels(hal::TimeNs now) noexcept;
  void note_firmware() noexcept;

  Calibration calibration_;
  ThymioRobot& robot_;
  std::vector<hal::InfraredResponse> response_;
  std::vector<Source> sources_;

  const aseba::Node* node_ = nullptr;  // null: not there
  std::uint64_t generation_ = 0;
  std::uint64_t times_wired_ = 0;
  std::string trouble_;  // of the node as it describes itself
  Program program_;
  aseba::ResidentProgram resident_;
  hal::TimeNs believed_from_ns_ = 0;  // readings from this time on
  std::vector<std::int16_t> held_;    // named words, as they were when the program was last seen to run afterwards
  std::vector<hal::TimeNs> held_ns_;  // when they were taken; 0: never
  std::string restarted_;             // for look_for_restarts

  Told told_;
  Block<kLedWords> leds_{mailbox::kLeds, mailbox::kShown};
  Block<2> tone_{mailbox::kTone, mailbox::kPlayed};
  std::array<std::int16_t, hal::Buttons::kCapacity> gathered_{};
  bool drives_ = false;
  bool firmware_told_ = false;

  hal::TimeNs wheels_ns_ = 0;  // of the speeds that were last added up
  double left_m_s_ = 0.0, right_m_s_ = 0.0;
  WiringStatistics statistics_;
};

}  // namespace tandem::bridges::thymio
