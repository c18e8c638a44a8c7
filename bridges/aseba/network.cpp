#include "bridges/aseba/network.hpp"

#include <limits>

namespace tandem::bridges::aseba {
namespace {

constexpr int kMostMessagesAPoll = 2000;            // so that a flooded bus cannot hold a loop for ever
constexpr hal::TimeNs kGrace = 40 * hal::kNsPerMs;  // a node just heard of may be about to describe itself unasked

char folded(char c) noexcept {
  if (c >= 'A' && c <= 'Z') return static_cast<char>(c - 'A' + 'a');
  return c == '_' || c == '-' ? ' ' : c;
}

bool same_name(std::string_view a, std::string_view b) noexcept {
  return std::ranges::equal(a, b, {}, folded, folded);
}

std::string title(const Node& node) {
  std::string text = "node " + std::to_string(node.id);
  if (!node.description.name.empty()) text += " '" + node.description.name + "'";
  return text;
}

}  // namespace

Network::Network(MessageLink& link, const NetworkTiming& timing, hal::Log log)
    : link_(link),
      timing_(timing),
      log_(std::move(log)),
      rows_(std::make_unique<std::array<Row, kNodeIds>>()),
      events_(std::make_unique<std::array<Event, kMostEvents>>()) {
  for (std::size_t i = 0; i < kNodeIds; ++i) (*rows_)[i].node.id = static_cast<std::uint8_t>(i);
}

const Node* Network::find(std::span<const std::string> names) const noexcept {
  for (const std::string& name : names) {
    for (const std::uint8_t id : known()) {
      const Node& known_node = (*rows_)[id].node;
      if (known_node.ready() && same_name(known_node.description.name, name)) return &known_node;
    }
  }
  return nullptr;
}

void Network::know(std::uint8_t id) noexcept {
  if (is_known_.test(id)) return;
  is_known_.set(id);
  known_[known_count_++] = id;
}

void Network::expect(std::uint8_t id) noexcept {
  if (id == kHost) return;
  expected_.set(id);
  know(id);
}

// --- what the user asks for ---

bool Network::want(std::uint8_t id, std::size_t address, std::size_t count) noexcept {
  Node& node = (*rows_)[id].node;
  if (!node.ready() || address > node.image.size() || count > node.image.size() - address) {
    ++node.statistics.refused;
    return false;
  }
  node.image.mark(address, count, Image::kWanted);
  deadline_ = 0;
  return true;
}

bool Network::write(std::uint8_t id, std::size_t address, std::span<const std::int16_t> values) noexcept {
  Node& node = (*rows_)[id].node;
  if (!node.ready() || address > node.image.size() || values.size() > node.image.size() - address) {
    ++node.statistics.refused;
    return false;
  }
  std::ranges::copy(values, node.image.to_write.begin() + static_cast<std::ptrdiff_t>(address));
  node.image.mark(address, values.size(), Image::kDirty);
  deadline_ = 0;
  return true;
}

void Network::forget_writes() noexcept {
  ++statistics_.stops;
  for (const std::uint8_t id : known()) {
    Image& image = (*rows_)[id].node.image;
    image.unmark(0, image.size(), Image::kDirty);
  }
  link_.clear();
}

bool Network::reading() const noexcept {
  return std::ranges::any_of(known(), [this](std::uint8_t id) {
    const Row& row = (*rows_)[id];
    const auto wanted = [](std::uint8_t marks) { return (marks & Image::kWanted) != 0; };
    return row.node.ready() && (row.read.active || std::ranges::any_of(row.node.image.marks, wanted));
  });
}

void Network::stalled(hal::TimeNs duration) noexcept {
  for (const std::uint8_t id : known()) {
    Row& row = (*rows_)[id];
    row.node.heard_ns += row.node.heard_ns != 0 ? duration : 0;
    row.read.excused_ns += row.read.active ? duration : 0;
    row.describe_at_ns += row.describe_at_ns != 0 ? duration : 0;
  }
  asking_until_ns_ += duration;
}

bool Network::send(const Message& message) noexcept {
  return encode(message, payload_) && link_.send(type_of(message), payload_.bytes());
}

bool Network::take_event(Event& event) noexcept {
  if (event_count_ == 0) return false;
  event = (*events_)[first_event_];
  first_event_ = (first_event_ + 1) % kMostEvents;
  --event_count_;
  return true;
}

// --- the poll ---

void Network::poll(hal::TimeNs now) noexcept {
  MessageView view;
  for (int i = 0; i < kMostMessagesAPoll && link_.receive(view); ++i) take_in(view, now);
  watch_carrier(now);
  deadline_ = std::numeric_limits<hal::TimeNs>::max();
  if (!up_) {
    due(now + 50 * hal::kNsPerMs);
    return;
  }
  if (statistics_.rounds == 0 || now - round_ns_ >= timing_.ping_ns) ask_round(now);
  due(std::max(round_ns_ + timing_.ping_ns, now + hal::kNsPerMs));
  for (const std::uint8_t id : known()) serve((*rows_)[id], now);
  // Writes first, unless they left no room for the reads the last time; and each time another node first.
  ++turn_;
  const bool first = send_all(!reads_first_, now);
  const bool second = send_all(reads_first_, now);
  if (!first || !second) due(now + hal::kNsPerMs);
  if (!second) reads_first_ = !reads_first_;
  ask_descriptions(now);
}

bool Network::send_all(bool writes, hal::TimeNs now) {
  bool all = true;
  for (std::size_t i = 0; i < known_count_; ++i) {
    Row& row = (*rows_)[known_[(i + turn_) % known_count_]];
    if (row.node.ready()) all = (writes ? send_writes(row) : send_read(row, now)) && all;
  }
  return all;
}

void Network::watch_carrier(hal::TimeNs now) noexcept {
  const bool up = link_.state() == Carrier::Up;
  if (up == up_) return;
  up_ = up;
  if (up) {
    round_ns_ = now - timing_.ping_ns;
    asked_all_ = false;
    asking_ = kNobody;
    return;
  }
  ++statistics_.carrier_losses;
  for (const std::uint8_t id : known()) {
    Row& row = (*rows_)[id];
    if (row.node.state != NodeState::Absent) lose(row, "nothing passes on the link");
  }
}

/// Asks who is there: all, and those who are awaited and silent one by one.
void Network::ask_round(hal::TimeNs now) noexcept {
  if (!send(ListNodes{kVersion})) return;  // again with the next poll
  ++statistics_.rounds;
  round_ns_ = now;
  bool anybody = false;
  for (const std::uint8_t id : known()) {
    Row& row = (*rows_)[id];
    Node& node = row.node;
    row.presented = 0;
    anybody = anybody || (node.state != NodeState::Absent && node.state != NodeState::Lost);
    const bool awaited = node.state != NodeState::Absent || expected_.test(node.id);
    const bool answers_list = node.version >= kVersion && node.state != NodeState::Lost;
    if (!awaited || answers_list || row.read.active) continue;
    if (now - node.heard_ns < timing_.ping_ns && node.heard_ns != 0) continue;
    row.pinged = send(GetVariables{node.id, 0, 1});
  }
  // Nodes of old answer nothing else. While nobody is there, they are called in every other round.
  if (!anybody && !asked_all_) {
    ask_all(now);
  } else if (!anybody) {
    asked_all_ = false;
  }
}

void Network::serve(Row& row, hal::TimeNs now) {
  Node& node = row.node;
  if (node.state == NodeState::Absent || node.state == NodeState::Lost) return;
  if (now - node.heard_ns > timing_.lost_ns) {
    lose(row, "it is silent");
    return;
  }
  due(node.heard_ns + timing_.lost_ns + 1);
}

void Network::lose(Row& row, std::string_view why) {
  if (row.node.ready() || row.node.state == NodeState::Present || row.node.state == NodeState::Refused) {
    ++row.node.statistics.times_lost;
    log_.warning(title(row.node) + " is lost: " + std::string(why));
  }
  row.node.state = NodeState::Lost;
  row.node.image.unmark(0, row.node.image.size(), Image::kDirty);
  row.draft.clear();
  row.has_candidate = false;
  row.describe_at_ns = 0;
  row.read = row.given_up = {};
  row.pinged = false;
}

// --- descriptions ---

/// Asks the one that has waited longest, unless a description is under way.
void Network::ask_descriptions(hal::TimeNs now) noexcept {
  if (asking_ != kNobody && now < asking_until_ns_) {
    due(asking_until_ns_);
    return;
  }
  asking_ = kNobody;
  Row* first = nullptr;
  for (const std::uint8_t id : known()) {
    Row& row = (*rows_)[id];
    if (row.describe_at_ns == 0) continue;
    if (first == nullptr || row.describe_at_ns < first->describe_at_ns) first = &row;
  }
  if (first == nullptr) return;
  if (now >= first->describe_at_ns) {
    ask_description(*first, now);
    due(asking_until_ns_);
  } else {
    due(first->describe_at_ns);
  }
}

void Network::ask_description(Row& row, hal::TimeNs now) noexcept {
  const bool old = row.node.version != 0 && row.node.version < kVersion;
  const bool unknown = row.node.version == 0;
  row.describe_at_ns = now + timing_.describe_ns;
  // A node of unknown version is asked in both ways in turn.
  if (old || (unknown && row.describe_tries++ % 2 == 1)) {
    ask_all(now);
    return;
  }
  drop_draft(row);
  send(GetNodeDescription{row.node.id, kVersion});
  asking_ = row.node.id;
  asking_until_ns_ = now + timing_.describe_ns;
}

void Network::ask_all(hal::TimeNs now) noexcept {
  for (const std::uint8_t id : known()) drop_draft((*rows_)[id]);
  asked_all_ = send(GetDescription{kOldVersion});
  asking_ = kAll;
  asking_until_ns_ = now + timing_.describe_ns;
}

void Network::drop_draft(Row& row) noexcept {
  if (row.draft.progress() == DescriptionDraft::Progress::None) return;
  ++row.node.statistics.incomplete;
  row.draft.clear();
}

void Network::on_description_part(Row& row, hal::TimeNs now) {
  using enum DescriptionDraft::Progress;
  const bool awaited = asking_ == kAll || asking_ == row.node.id;
  if (awaited) asking_until_ns_ = now + timing_.describe_ns;
  const bool ends = row.draft.progress() == Complete || row.draft.progress() == Refused;
  if (ends && asking_ == row.node.id) asking_ = kNobody;
  switch (row.draft.progress()) {
    case None:
      break;  // the rest of something whose beginning was lost
    case Collecting:
      row.describe_at_ns = now + timing_.describe_ns;
      break;
    case Complete:
      on_complete(row, now);
      break;
    case Refused:
      ++row.node.statistics.impossible;
      row.node.trouble = row.draft.trouble();
      row.describe_at_ns = now + timing_.refused_ns;
      if (!row.node.ready() && row.node.state != NodeState::Refused) {
        log_.warning(title(row.node) + ": " + row.node.trouble);
        row.node.state = NodeState::Refused;
      }
      row.draft.clear();
      break;
  }
}

void Network::on_complete(Row& row, hal::TimeNs now) {
  Node& node = row.node;
  const NodeDescription& said = row.draft.description();
  ++node.statistics.descriptions;
  node.version = said.version;
  row.describe_at_ns = 0;
  const bool as_before = node.generation > 0 && said == node.description;
  if (node.ready() && as_before) {
    row.has_candidate = false;
    row.draft.clear();
    return;
  }
  const bool twice = row.has_candidate && said == row.candidate;
  if (!as_before && !twice) {
    if (row.has_candidate || node.ready()) ++node.statistics.changed;
    if (node.ready()) {
      node.image.unmark(0, node.image.size(), Image::kWanted | Image::kDirty);
      row.read = row.given_up = {};
      log_.warning(title(node) + " describes itself otherwise than before");
    }
    row.candidate = said;
    row.has_candidate = true;
    node.state = NodeState::Present;
    row.draft.clear();
    row.describe_at_ns = now;
    return;
  }
  accept(row);
}

void Network::accept(Row& row) {
  Node& node = row.node;
  const bool as_before = node.generation > 0 && row.draft.description() == node.description;
  const std::vector<std::uint8_t> marks = as_before ? std::move(node.image.marks) : std::vector<std::uint8_t>();
  node.description = row.draft.description();
  node.image.resize(std::min<std::size_t>(node.description.variable_words, DescriptionDraft::kMostMemory));
  for (std::size_t i = 0; i < marks.size(); ++i) node.image.marks[i] = marks[i] & Image::kWanted;
  node.state = NodeState::Ready;
  node.trouble.clear();
  ++node.generation;
  ++node.statistics.times_ready;
  row.read = row.given_up = {};
  row.cursor = 0;
  row.has_candidate = false;
  row.describe_tries = 0;
  row.draft.clear();
  log_.info(title(node) + " is ready: protocol " + std::to_string(node.description.version) + ", " +
            std::to_string(node.description.variables.size()) + " variables");
}

// --- messages ---

void Network::take_in(const MessageView& view, hal::TimeNs now) {
  ++statistics_.messages;
  const bool from_host = view.source == kHost || view.type >= kFirstCommand;
  if (from_host) ++statistics_.other_hosts;
  if (view.source >= kNodeIds) return;
  const Decoded decoded = decode(view.type, view.payload, message_);
  if (decoded != Decoded::Good) ++statistics_.not_understood;
  if (view.type < kFirstBootloader && decoded == Decoded::Good) keep_event(view);
  if (from_host) return;
  Row& row = (*rows_)[view.source];
  Node& node = row.node;
  ++node.statistics.messages;
  node.heard_ns = std::max<hal::TimeNs>(now, 1);
  if (node.state == NodeState::Absent || node.state == NodeState::Lost) {
    node.state = NodeState::Present;
    row.describe_at_ns = now + kGrace;
    row.describe_tries = 0;
    know(node.id);
  }
  if (decoded != Decoded::Good) {
    ++node.statistics.not_understood;
    return;
  }
  on(row, view, message_, now);
}

void Network::on(Row& row, const MessageView& view, const Message& message, hal::TimeNs now) {
  Node& node = row.node;
  if (const auto* variables = std::get_if<Variables>(&message)) {
    on_variables(row, *variables, view.at_ns);
  } else if (const auto* present = std::get_if<NodePresent>(&message)) {
    node.version = present->number;
    if (++row.presented > 1) ++node.statistics.doubled;
  } else if (const auto* description = std::get_if<Description>(&message)) {
    if (row.draft.progress() == DescriptionDraft::Progress::Collecting) ++node.statistics.incomplete;
    node.version = description->version;
    row.draft.begin(*description);
    on_description_part(row, now);
  } else if (const auto* variable = std::get_if<NamedVariable>(&message)) {
    row.draft.add(*variable);
    on_description_part(row, now);
  } else if (const auto* event = std::get_if<LocalEvent>(&message)) {
    row.draft.add(*event);
    on_description_part(row, now);
  } else if (const auto* function = std::get_if<NativeFunction>(&message)) {
    row.draft.add(*function);
    on_description_part(row, now);
  } else if (std::holds_alternative<Disconnected>(message)) {
    lose(row, "a switch says that it has left");
  } else if (std::holds_alternative<UserEvent>(message)) {
    ++node.statistics.events;
  } else if (const auto* bounds = std::get_if<OutOfBounds>(&message)) {
    program_error(row, "index " + std::to_string(bounds->index) + " of an array of " + std::to_string(bounds->size) +
                           " at " + std::to_string(bounds->pc));
  } else if (const auto* division = std::get_if<DivisionByZero>(&message)) {
    program_error(row, "division by zero at " + std::to_string(division->number));
  } else if (const auto* killed = std::get_if<ExecutionKilled>(&message)) {
    program_error(row, "killed at " + std::to_string(killed->number));
  } else if (const auto* error = std::get_if<NodeError>(&message)) {
    program_error(row, std::string(error->text) + " at " + std::to_string(error->pc));
  }
}

void Network::program_error(Row& row, std::string what) {
  ++row.node.statistics.program_errors;
  row.node.trouble = "its program was stopped: " + std::move(what);
  log_.warning(title(row.node) + ": " + row.node.trouble);
}

void Network::keep_event(const MessageView& view) noexcept {
  ++statistics_.events;
  if (event_count_ == kMostEvents) {
    ++statistics_.events_dropped;
    first_event_ = (first_event_ + 1) % kMostEvents;
    --event_count_;
  }
  Event& event = (*events_)[(first_event_ + event_count_++) % kMostEvents];
  const Words words(view.payload);
  event.source = view.source;
  event.number = view.type;
  event.at_ns = view.at_ns;
  event.count = words.size();
  for (std::size_t i = 0; i < words.size(); ++i) event.arguments[i] = words[i];
}

// --- variables ---

void Network::on_variables(Row& row, const Variables& variables, hal::TimeNs at) noexcept {
  Node& node = row.node;
  const std::size_t start = variables.start;
  const std::size_t count = variables.words.size();
  if (row.pinged && start == 0 && count == 1) {
    row.pinged = false;
  } else if (row.read.active && start == row.read.start) {
    if (count != row.read.count) {
      ++node.statistics.wrong_length;  // a fragment was lost or doubled: which words these are is not known
      return;
    }
    row.read.active = false;
    node.image.unmark(start, count, Image::kWanted);
    ++node.statistics.answers;
    node.statistics.round_trips.add(at - row.read.asked_ns);
    row.given_up = {};
  } else {
    ++node.statistics.unasked;  // late, or another host's: nothing vouches for its length
    return;
  }
  if (!node.ready() || start + count > node.image.size()) return;
  const hal::TimeNs taken_ns = measured_ns(row, at);
  for (std::size_t i = 0; i < count; ++i) {
    node.image.values[start + i] = variables.words[i];
    node.image.taken_ns[start + i] = std::max<hal::TimeNs>(taken_ns, 1);
  }
}

/// When the module looked, which answered at `at`: in the middle between question and answer. Of a question that was
/// repeated it is the last one that was answered, unless answers are so slow here that it may have been the first.
hal::TimeNs Network::measured_ns(const Row& row, hal::TimeNs at) const noexcept {
  const NodeStatistics& s = row.node.statistics;
  if (row.read.asked_ns == 0) return at;
  const bool quick = s.answers > 0 && 4 * s.round_trips.mean_ns() < timing_.reply_ns;
  const hal::TimeNs asked_ns = quick ? row.read.asked_ns : row.read.first_ns;
  return at - std::max<hal::TimeNs>(at - asked_ns, 0) / 2;
}

bool Network::send_writes(Row& row) noexcept {
  Image& image = row.node.image;
  for (std::size_t from = 0; true;) {
    const Image::Range range = image.next(Image::kDirty, from, kMostWrite, 0);
    if (range.count == 0) return true;
    words_.clear();
    words_.append(std::span<const std::int16_t>(image.to_write).subspan(range.start, range.count));
    if (!send(SetVariables{row.node.id, static_cast<std::uint16_t>(range.start), words_.words()})) return false;
    image.unmark(range.start, range.count, Image::kDirty);
    ++row.node.statistics.writes;
    from = range.start + range.count;
  }
}

bool Network::send_read(Row& row, hal::TimeNs now) noexcept {
  Node& node = row.node;
  Read& read = row.read;
  if (read.active && now - read.asked_ns < timing_.reply_ns + read.excused_ns) {
    due(read.asked_ns + timing_.reply_ns + read.excused_ns);
    return true;
  }
  if (read.active && read.tries >= timing_.read_tries) {
    ++node.statistics.unanswered;
    row.given_up = read;
    read = {};  // old values stay, with their age; it is asked for again when others had their turn
  }
  if (!read.active) {
    Image::Range range = node.image.next(Image::kWanted, row.cursor, kMostRead, timing_.merge_gap);
    if (range.count == 0) range = node.image.next(Image::kWanted, 0, kMostRead, timing_.merge_gap);
    if (range.count == 0) return true;
    const bool again = row.given_up.active && row.given_up.start == range.start;
    read = {true, range.start, range.count, now, again ? row.given_up.first_ns : now, 0, 0};
    row.cursor = range.start + range.count;
  }
  if (!send(GetVariables{node.id, static_cast<std::uint16_t>(read.start), static_cast<std::uint16_t>(read.count)})) {
    if (read.tries == 0) read = {};
    return false;
  }
  ++(read.tries++ == 0 ? node.statistics.reads : node.statistics.asked_again);
  read.asked_ns = now;
  read.excused_ns = 0;
  due(now + timing_.reply_ns);
  return true;
}

}  // namespace tandem::bridges::aseba
