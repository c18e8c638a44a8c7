// The nodes on one robot's bus: presence, variables, values.
//
//   absent, lost --anything is heard--> present --the same description twice--> ready
//   present --a description that cannot be--> refused --a possible one--> present
//   ready --another description--> present;  any --silence, or the carrier is down--> lost
//
// Discovery asks in both ways of the protocol: LIST_NODES and GET_NODE_DESCRIPTION for version 5, GET_DESCRIPTION for
// older nodes, to which nodes of version 5 answer as well when it names version 4. Fragments carry no numbers, so a
// lost, doubled or overtaken frame can shift a variable's address unseen: a description is believed when it came twice
// the same, or once as it was believed before. Nodes are asked one after the other: nine modules that describe
// themselves at once fill a bus of 1 Mbit/s for half a second.
//
// Reads and writes are marks on an image of each node's memory, never a queue: a newer write replaces an older one, a
// stop forgets them all, and nothing that could not be sent piles up.
#pragma once
#include <array>
#include <bitset>
#include <memory>

#include "bridges/aseba/message_link.hpp"
#include "bridges/aseba/node.hpp"
#include "hal/log.hpp"

namespace tandem::bridges::aseba {

struct NetworkTiming {
  hal::TimeNs ping_ns = 300 * hal::kNsPerMs;      ///< between rounds of asking for nodes
  hal::TimeNs describe_ns = 150 * hal::kNsPerMs;  ///< without progress of a description until it is asked for again
  hal::TimeNs refused_ns = 400 * hal::kNsPerMs;   ///< until a node whose description was refused is asked again
  hal::TimeNs reply_ns = 100 * hal::kNsPerMs;     ///< for an answer to a read
  int read_tries = 2;                             ///< until another read has its turn
  hal::TimeNs lost_ns = 1200 * hal::kNsPerMs;     ///< of silence until a node counts as lost
  std::size_t merge_gap = 8;                      ///< unwanted words that a read takes along rather than being two
};

/// A user event as it came.
struct Event {
  std::uint16_t source = 0;
  std::uint16_t number = 0;
  std::size_t count = 0;
  std::array<std::int16_t, kMostWords> arguments{};
  hal::TimeNs at_ns = 0;
};

struct NetworkStatistics {
  std::uint64_t messages = 0;
  std::uint64_t not_understood = 0;  ///< their payload is not that of their type, or the type is unknown
  std::uint64_t other_hosts = 0;     ///< messages that only a host sends: there is another one on this bus
  std::uint64_t rounds = 0;          ///< of asking for nodes
  std::uint64_t events = 0;
  std::uint64_t events_dropped = 0;  ///< not taken in time; the oldest go first
  std::uint64_t stops = 0;           ///< calls of `forget_writes`
  std::uint64_t carrier_losses = 0;
};

/// One bus. Not thread-safe. Allocates when a node is described, else never. Times never run backwards.
class Network {
 public:
  static constexpr std::size_t kMostEvents = 64;  ///< that wait for `take_event`

  /// `link` must outlive this.
  explicit Network(MessageLink& link, const NetworkTiming& timing = {}, hal::Log log = {});

  /// Asks for a node also when it was never heard of: how an old one that is switched on late is found soon.
  void expect(std::uint8_t id) noexcept;

  /// Takes in what has arrived, applies time-outs, sends what is due. Never waits.
  void poll(hal::TimeNs now) noexcept;
  /// Some words are wanted that were not answered yet.
  bool reading() const noexcept;
  /// Our own thread came too late by so much: no time-out counts it. Before the next `poll`.
  void stalled(hal::TimeNs duration) noexcept;
  /// When to call `poll` at the latest, unless the link has something before.
  hal::TimeNs next_deadline() const noexcept { return deadline_; }

  const Node& node(std::uint8_t id) const noexcept { return (*rows_)[id].node; }
  /// Ids that were ever heard of or are expected, in this order.
  std::span<const std::uint8_t> known() const noexcept { return std::span(known_).first(known_count_); }
  /// The first Ready node with one of these names, whatever their case; space, `-` and `_` are the same. Or null.
  const Node* find(std::span<const std::string> names) const noexcept;

  /// Has these words read with the next polls, and asked for again until they are answered, also of a node that was
  /// lost meanwhile and came back as it was; see `Node::taken_ns`. False, and counted: not Ready, or outside.
  bool want(std::uint8_t id, std::size_t address, std::size_t count) noexcept;
  /// Has these words written with the next poll. There is no acknowledgement in the protocol: read back where it
  /// matters. False, and counted: not Ready, or outside.
  bool write(std::uint8_t id, std::size_t address, std::span<const std::int16_t> values) noexcept;
  /// Forgets every write that has not left yet, here and in the link's queue. What is written afterwards goes first.
  void forget_writes() noexcept;
  /// Sends any message; a user event goes to all. False: not taken, or not a message.
  bool send(const Message& message) noexcept;
  /// The oldest event that waits. False when there is none.
  bool take_event(Event& event) noexcept;

  Carrier carrier() const noexcept { return link_.state(); }
  const NetworkStatistics& statistics() const noexcept { return statistics_; }

 private:
  struct Read {
    bool active = false;
    std::size_t start = 0, count = 0;
    hal::TimeNs asked_ns = 0;  // the last time
    hal::TimeNs first_ns = 0;
    hal::TimeNs excused_ns = 0;  // of the wait for its answer
    int tries = 0;
  };
  struct Row {
    Node node;
    DescriptionDraft draft;
    NodeDescription candidate;  // came once
    bool has_candidate = false;
    hal::TimeNs describe_at_ns = 0;  // 0: not due
    int describe_tries = 0;
    Read read;
    Read given_up;           // the last one that was; its answer may yet come
    std::size_t cursor = 0;  // where the next read begins to look
    bool pinged = false;
    int presented = 0;  // times in this round
  };

  void watch_carrier(hal::TimeNs now) noexcept;
  void take_in(const MessageView& view, hal::TimeNs now);
  void on(Row& row, const MessageView& view, const Message& message, hal::TimeNs now);
  void on_description_part(Row& row, hal::TimeNs now);
  void on_complete(Row& row, hal::TimeNs now);
  void on_variables(Row& row, const Variables& variables, hal::TimeNs at) noexcept;
  hal::TimeNs measured_ns(const Row& row, hal::TimeNs at) const noexcept;
  void keep_event(const MessageView& view) noexcept;
  void program_error(Row& row, std::string what);
  void accept(Row& row);
  void lose(Row& row, std::string_view why);
  void ask_round(hal::TimeNs now) noexcept;
  void serve(Row& row, hal::TimeNs now);
  void ask_descriptions(hal::TimeNs now) noexcept;
  void ask_description(Row& row, hal::TimeNs now) noexcept;
  void ask_all(hal::TimeNs now) noexcept;
  void drop_draft(Row& row) noexcept;
  void know(std::uint8_t id) noexcept;
  bool send_all(bool writes, hal::TimeNs now);
  bool send_writes(Row& row) noexcept;
  bool send_read(Row& row, hal::TimeNs now) noexcept;
  void due(hal::TimeNs at) noexcept { deadline_ = std::min(deadline_, at); }

  MessageLink& link_;
  NetworkTiming timing_;
  hal::Log log_;
  std::unique_ptr<std::array<Row, kNodeIds>> rows_;
  std::array<std::uint8_t, kNodeIds> known_{};  // ids that were heard or are expected
  std::size_t known_count_ = 0;
  std::bitset<kNodeIds> is_known_;
  std::bitset<kNodeIds> expected_;
  std::unique_ptr<std::array<Event, kMostEvents>> events_;
  std::size_t first_event_ = 0;
  std::size_t event_count_ = 0;
  Message message_;
  Payload payload_, words_;
  bool up_ = false;
  hal::TimeNs round_ns_ = 0;  // of the last round
  static constexpr int kNobody = -1, kAll = -2;
  int asking_ = kNobody;  // whose description is under way
  hal::TimeNs asking_until_ns_ = 0;
  bool asked_all_ = false;  // in the last round
  std::size_t turn_ = 0;    // which node is served first
  bool reads_first_ = false;
  hal::TimeNs deadline_ = 0;
  NetworkStatistics statistics_;
};

}  // namespace tandem::bridges::aseba
