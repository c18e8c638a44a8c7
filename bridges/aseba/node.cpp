#include "bridges/aseba/node.hpp"

#include <cstring>

namespace tandem::bridges::aseba {

const Variable* NodeDescription::variable(std::string_view variable_name) const noexcept {
  const auto found = std::ranges::find(variables, variable_name, &Variable::name);
  return found == variables.end() ? nullptr : &*found;
}

std::size_t NodeDescription::named_words() const noexcept {
  return variables.empty() ? 0 : std::size_t{variables.back().address} + variables.back().words;
}

// --- description ---

void DescriptionDraft::clear() {
  progress_ = Progress::None;
  description_ = {};
  words_ = 0;
  trouble_.clear();
}

void DescriptionDraft::refuse(std::string why) {
  progress_ = Progress::Refused;
  trouble_ = "node '" + description_.name + "' describes itself as it cannot be: " + std::move(why);
}

void DescriptionDraft::look_whether_complete() noexcept {
  if (progress_ == Progress::Collecting && description_.variables.size() == variables_ &&
      description_.local_events.size() == events_ && description_.native_functions.size() == functions_) {
    progress_ = Progress::Complete;
  }
}

void DescriptionDraft::begin(const Description& description) {
  clear();
  progress_ = Progress::Collecting;
  description_.name = description.name;
  description_.version = description.version;
  description_.bytecode_words = description.bytecode_words;
  description_.variable_words = description.variable_words;
  variables_ = description.named_variables;
  events_ = description.local_events;
  functions_ = description.native_functions;
  if (variables_ > kMostVariables) {
    refuse(std::to_string(variables_) + " named variables; at most " + std::to_string(kMostVariables) + " are taken");
  } else if (variables_ > description.variable_words) {
    refuse(std::to_string(variables_) + " named variables in " + std::to_string(description.variable_words) + " words");
  } else if (events_ > kMostNames || functions_ > kMostNames) {
    refuse(std::to_string(events_) + " local events and " + std::to_string(functions_) + " native functions; at most " +
           std::to_string(kMostNames) + " of each are taken");
  }
  look_whether_complete();
}

void DescriptionDraft::add(const NamedVariable& variable) {
  if (progress_ == Progress::Complete) return refuse("more variables than announced");
  if (progress_ != Progress::Collecting) return;
  const std::string name(variable.name);
  if (description_.variables.size() == variables_) return refuse("more variables than announced, from '" + name + "'");
  if (!description_.local_events.empty() || !description_.native_functions.empty()) {
    return refuse("variable '" + name + "' comes behind events or functions, so some message was lost");
  }
  if (variable.words == 0) return refuse("variable '" + name + "' has no words");
  if (description_.variable(name) != nullptr) return refuse("variable '" + name + "' comes twice");
  if (words_ + variable.words > std::min<std::size_t>(description_.variable_words, kMostMemory)) {
    return refuse("variable '" + name + "' with " + std::to_string(variable.words) + " words at " +
                  std::to_string(words_) + " reaches beyond " +
                  std::to_string(std::min<std::size_t>(description_.variable_words, kMostMemory)) + " words of memory");
  }
  description_.variables.push_back({name, static_cast<std::uint16_t>(words_), variable.words});
  words_ += variable.words;
  look_whether_complete();
}

void DescriptionDraft::add(const LocalEvent& event) {
  if (progress_ == Progress::Complete) return refuse("more local events than announced");
  if (progress_ != Progress::Collecting) return;
  if (description_.local_events.size() == events_) return refuse("more local events than announced");
  if (description_.variables.size() != variables_) return refuse("variables are missing before its local events");
  description_.local_events.emplace_back(event.name);
  look_whether_complete();
}

void DescriptionDraft::add(const NativeFunction& function) {
  if (progress_ == Progress::Complete) return refuse("more native functions than announced");
  if (progress_ != Progress::Collecting) return;
  if (description_.native_functions.size() == functions_) return refuse("more native functions than announced");
  if (description_.variables.size() != variables_ || description_.local_events.size() != events_) {
    return refuse("variables or local events are missing before its native functions");
  }
  description_.native_functions.emplace_back(function.name);
  look_whether_complete();
}

// --- image ---

void Image::resize(std::size_t words) {
  values.assign(words, 0);
  taken_ns.assign(words, 0);
  to_write.assign(words, 0);
  marks.assign(words, 0);
}

void Image::mark(std::size_t start, std::size_t count, std::uint8_t mark) noexcept {
  for (std::size_t i = start; i < start + count; ++i) marks[i] = static_cast<std::uint8_t>(marks[i] | mark);
}

void Image::unmark(std::size_t start, std::size_t count, std::uint8_t mark) noexcept {
  for (std::size_t i = start; i < start + count; ++i) marks[i] = static_cast<std::uint8_t>(marks[i] & ~mark);
}

Image::Range Image::next(std::uint8_t mark, std::size_t from, std::size_t most, std::size_t gap) const noexcept {
  std::size_t start = from;
  std::uint64_t eight = 0;  // marks at once: mostly none of a node's whole memory is set
  const std::uint64_t mark_of_each = mark * std::uint64_t{0x0101'0101'0101'0101};
  for (; start + sizeof eight <= marks.size(); start += sizeof eight) {
    std::memcpy(&eight, &marks[start], sizeof eight);
    if ((eight & mark_of_each) != 0) break;
  }
  while (start < marks.size() && (marks[start] & mark) == 0) ++start;
  if (start >= marks.size()) return {};
  std::size_t end = start + 1;  // behind the last marked word
  for (std::size_t i = end; i < marks.size() && i < start + most && i <= end + gap; ++i) {
    if ((marks[i] & mark) != 0) end = i + 1;
  }
  return {start, end - start};
}

hal::TimeNs Node::taken_ns(std::size_t address, std::size_t count) const noexcept {
  if (count == 0 || address + count > image.size()) return 0;
  return *std::min_element(image.taken_ns.begin() + static_cast<std::ptrdiff_t>(address),
                           image.taken_ns.begin() + static_cast<std::ptrdiff_t>(address + count));
}

const char* node_state_name(NodeState state) noexcept {
  constexpr std::array kNames = {"absent", "present", "refused", "ready", "lost"};
  return kNames[static_cast<std::size_t>(state)];
}

}  // namespace tandem::bridges::aseba
