// Ports on one side, nodes on the other: finds the map's variables on the bus, and carries values both ways.
#pragma once
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "bridges/aseba/dead_man.hpp"
#include "bridges/aseba/node_driver.hpp"
#include "bridges/footbot/map.hpp"
#include "bridges/footbot/memory_watch.hpp"
#include "bridges/footbot/robot.hpp"
#include "bridges/footbot/words.hpp"
#include "hal/device/range_and_bearing.hpp"

namespace tandem::bridges::footbot {

using aseba::NodeStatus;
using aseba::RestMessage;

struct WiringStatistics {
  std::uint64_t counter_jumps = 0;  ///< counters that changed faster than can be, or started again
  std::uint64_t restarts = 0;       ///< of nodes that the robot never drives without, as far as their words show it
  std::uint64_t not_obeyed = 0;     ///< written values that were not there when read back
  std::uint64_t packets_unfit = 0;  ///< range-and-bearing events of another length than the map says
  std::uint64_t packets = 0;        ///< range-and-bearing messages received
  std::uint64_t dead_men = 0;       ///< nodes that stop by themselves when they hear nothing, by now
  std::uint64_t lapses = 0;         ///< times that one did
  std::uint64_t programs_gone = 0;  ///< times that its program was

  void describe(StatusVisitor& visitor) const;
};

/// Not thread-safe. Allocates when nodes come and go, else never.
class Wiring : public aseba::NodeWiring {
 public:
  using Statistics = WiringStatistics;

  /// All three must outlive this. `observe`: nothing is ever written.
  Wiring(const FootbotMap& map, aseba::Network& network, FootbotRobot& robot, bool observe = false);

  /// Notes which ports were taken since the last call: they decide what is read and written.
  void note_demand() noexcept;
  /// Looks for modules. True when something changed.
  bool look() noexcept;
  /// Looks whether nodes that the robot never drives without have lost their memory. @returns what happened, for
  /// people; "" when nothing did.
  std::string look_for_restarts() noexcept;
  /// Does what this kind of robot needs beside variables: takes over the range-and-bearing messages that came.
  /// @returns whether there is something to send.
  bool serve(hal::TimeNs now) noexcept;

  /// Fills the readings of the ports that were taken.
  void fill(hal::TimeNs now) noexcept;
  /// Has the network read what is due.
  void ask(hal::TimeNs now) noexcept;
  /// Has the network write what the commands say, where it has changed or is due again. Not `drive`: everything rests.
  void command(bool drive, hal::TimeNs now) noexcept;
  /// Has everything rest at once, and asks whether it was heard.
  void rest(hal::TimeNs now) noexcept;
  /// The resting values were read back from every node that the robot never drives without.
  bool rests() const noexcept;

  /// Every node that is needed is there, with all its variables.
  bool complete() const noexcept;
  /// Some node that is needed, and was there, is gone.
  bool lost_needed() const noexcept;
  /// When the oldest of the words was read that needed nodes are asked for in every tick; 0: some never was since its
  /// node came.
  hal::TimeNs oldest_ns() const noexcept;
  /// What is missing, for people; "" when nothing that is used is.
  std::string trouble() const;
  /// As `trouble`, of needed nodes alone.
  std::string needed_trouble() const;

  std::vector<NodeStatus> nodes() const;
  /// The names of the nodes that are there.
  void identify(bridges::RobotIdentity& identity) const;
  /// Messages that have everything rest, to stop the robot when this process cannot. They are right as
  /// long as the nodes that are there now keep their descriptions.
  std::vector<RestMessage> rest_messages() const;
  const WiringStatistics& statistics() const noexcept { return statistics_; }

 private:
  struct Counter {
    bool known = false;
    std::int32_t raw = 0;
    std::int64_t total = 0;
  };
  struct FieldRow {
    const FieldMap* map;
    hal::TimeNs taken_ns = 0;  // of the values that are in the port
    std::vector<Counter> counters;
    ModuleCounter module_counter = {};  // of number 0, where it counts
  };
  struct VariableRow {
    const VariableMap* map;
    bool bound = false;
    std::uint16_t address = 0;
    std::size_t read_first = 0, read_behind = 0;  // words that are read; none: empty
    bool controlled = false;                      // it is written
    hal::TimeNs asked_ns = 0;
    std::vector<std::int16_t> target, sent;
    bool sent_known = false;
    hal::TimeNs sent_ns = 0;
    ToldWords told = {};
    std::vector<FieldRow> reads;
  };
  struct NodeRow {
    const NodeMap* map;
    const aseba::Node* node = nullptr;  // null: not there
    std::uint64_t generation = 0;
    bool used = false;
    std::string trouble;
    std::uint64_t times_wired = 0;
    std::vector<VariableRow> variables;
    aseba::ResidentProgram dead_man;
    bool has_dead_man = false;     // it can have one
    std::string dead_man_trouble;  // why not
    std::int16_t alive = -1;       // its last command; -1: not yet
    hal::TimeNs alive_ns = 0, driven_since_ns = 0, mail_asked_ns = 0;
    std::string stopped_itself;       // for look_for_restarts
    hal::TimeNs restart_told_ns = 0;  // by its memory or by its program, whichever showed it first
  };

  static bool needed(const NodeRow& row) noexcept {
    return row.map->need == Need::Always || (row.map->need == Need::Used && row.used);
  }
  static bool ready(const NodeRow& row) noexcept {
    return row.node != nullptr && row.node->ready() && row.node->generation == row.generation;
  }
  bool complete(const NodeRow& row) const noexcept {
    return ready(row) && row.trouble.empty() && !awaits_dead_man(row);
  }
  bool awaits_dead_man(const NodeRow& row) const noexcept;
  std::string trouble_of(const NodeRow& row) const;
  void bind(NodeRow& row, const aseba::Node* node);
  void bind(NodeRow& row, VariableRow& variable);
  void bind_dead_man(NodeRow& row);
  void serve_packets() noexcept;
  bool serve_dead_man(NodeRow& row, hal::TimeNs now) noexcept;
  void tell_alive(NodeRow& row, bool drive, hal::TimeNs now) noexcept;
  void fill_port(const hal::PortType& type, hal::TimeNs now) noexcept;
  void fill_field(const aseba::Node& node, const VariableRow& variable, FieldRow& field, hal::TimeNs taken) noexcept;
  double counted(FieldRow& field, std::size_t i, std::int32_t raw, double since_s) noexcept;
  void fill_packets(hal::TimeNs now) noexcept;
  void make_target(const VariableMap& map, bool drive, std::span<std::int16_t> target) const noexcept;
  void write(NodeRow& row, VariableRow& variable, bool drive, hal::TimeNs now) noexcept;
  bool rests(const NodeRow& row, const VariableRow& variable) const noexcept;
  bool forgot(const NodeRow& row, VariableRow& variable) const noexcept;

  const FootbotMap& map_;
  FootbotRobot& robot_;
  std::vector<NodeRow> rows_;
  hal::TimeNs served_ns_ = 0;
  hal::RangeAndBearing heard_;  // since the last `fill`
  aseba::Event event_;
  WiringStatistics statistics_;
};

}  // namespace tandem::bridges::footbot
