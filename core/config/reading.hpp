// Tools of all parts of the reader of experiment files: elements read by their schema, and problems noted.
#pragma once
#include <algorithm>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "core/config/reader.hpp"
#include "core/config/schema.hpp"
#include "core/scenario/engine_traits.hpp"
#include "core/scenario/field_type.hpp"
#include "core/scenario/medium_type.hpp"
#include "core/scenario/observer_type.hpp"
#include "core/scenario/run_part_type.hpp"
#include "hal/port.hpp"

namespace tandem::core {

/// The words of a list separated by spaces.
std::vector<std::string> words(std::string_view list);

/// "x,y", each a length; nothing: it is not that.
std::optional<Point2> point_of(const std::string& text);

/// What the catalog has, so that the reader can judge names.
struct KnownNames {
  std::vector<std::string> robots, engines, media, fields, observers, run_parts, trackers, sensors, actuators;
  const hal::Catalog& catalog;
  explicit KnownNames(const hal::Catalog& catalog);

  /// The names of an element's children, with those of all kinds in the place of what stands for them.
  std::vector<std::string> children_of(std::vector<std::string> names) const;
  /// An engine's traits; null: there is none of that name.
  const KnownEngine* engine(std::string_view kind) const noexcept { return catalog.find<KnownEngine>(kind); }
};

/// The names of all elements that an experiment file may hold.
std::set<std::string> element_names(const KnownNames& known);

/// One reading of one file: what is known, what was found, and the Scenario in the making.
class Reading {
 public:
  Reading(const hal::Catalog& catalog, Problems& problems) : catalog_(catalog), known_(catalog), problems_(problems) {}

  const hal::Catalog& catalog() const noexcept { return catalog_; }
  const KnownNames& known() const noexcept { return known_; }
  Scenario& out() noexcept { return out_; }
  /// Parts that the file's <fitted> gives robots of that kind; null: none.
  const std::vector<hal::AnyPart>* fitted(const std::string& kind) const noexcept {
    const auto found = fitted_.find(kind);
    return found == fitted_.end() ? nullptr : &found->second;
  }
  void add_fitted(const std::string& kind, std::vector<hal::AnyPart> parts) {
    fitted_.insert_or_assign(kind, std::move(parts));
  }

  void error(const Element& e, std::string message) { problems_.push_back(problem_at(e, std::move(message))); }
  void error(const Element& e, std::string_view attribute, std::string message) {
    problems_.push_back(problem_at(e, attribute, std::move(message)));
  }
  void warn(const Element& e, std::string message) {
    problems_.push_back(problem_at(e, std::move(message)));
    problems_.back().warning = true;
  }

  /// Something that nothing reads: an error, in an ARGoS file a warning.
  void unread(const Element& e, std::string message) { problems_.push_back(unread_at(e, std::move(message))); }
  void unread(const Element& e, std::string_view attribute, std::string message) {
    problems_.push_back(unread_at(e, attribute, std::move(message)));
  }
  /// While `on`, ids are beginnings of names that numbers end, and may be empty.
  void number_things(bool on) noexcept { numbered_ = on; }
  void add_problems(Problems found) { problems_.insert(problems_.end(), found.begin(), found.end()); }

  /// Reads an element by the schema of `T`: required and unknown attributes, values, children. Attributes that were
  /// left out are then written into it, so that it shows the effective settings.
  template <class T>
  T read(Element& element, T value = {}) {
    const std::vector<std::string> missing = check(element, T::kElement);
    ElementReader reader(element, problems_);
    value.describe(reader);
    reader.finish_attributes();
    ElementWriter writer(element);
    value.describe(writer);
    drop(element, missing);
    return value;
  }

  /// The same for an element whose further attributes and children are a part's own; `more(visitor)` describes those,
  /// first to be filled in, then to show what was left out.
  template <class T, class More>
  T read_with(Element& element, More&& more, T value = {}) {
    const std::vector<std::string> missing = check(element, T::kElement);
    ElementReader reader(element, problems_);
    value.describe(reader);
    more(reader);
    reader.finish();
    ElementWriter writer(element);
    value.describe(writer);
    more(writer);
    drop(element, missing);
    return value;
  }

  /// The same for an element whose further attributes belong to others.
  template <class T>
  T read_open(Element& element, T value = {}) {
    check(element, T::kElement);
    ElementReader reader(element, problems_);
    value.describe(reader);
    return value;
  }

  /// Checks required attributes and children.
  /// @returns the required attributes that are not there
  std::vector<std::string> check(const Element& element, const schema::ElementInfo& info);

  /// The only child of that name, or null; a second one is not read.
  Element* only(Element& parent, std::string_view name);

  /// Calls `use` for the only child of that name, if it is there.
  template <class Use>
  void once(Element& parent, std::string_view name, Use&& use) {
    if (Element* child = only(parent, name); child != nullptr) use(*child);
  }

  /// The same; a child that was left out is added, so that its defaults show.
  template <class Use>
  void once_or_default(Element& parent, std::string_view name, Use&& use) {
    if (parent.child(name) == nullptr) add_child(parent, name);
    once(parent, name, use);
  }

  static Element& add_child(Element& parent, std::string_view name);
  /// Takes attributes away.
  static void drop(Element& element, const std::vector<std::string>& names) {
    std::erase_if(element.attributes,
                  [&](const auto& a) { return std::find(names.begin(), names.end(), a.name) != names.end(); });
  }

  bool is_robot(const std::string& kind) const {
    return std::find(known_.robots.begin(), known_.robots.end(), kind) != known_.robots.end();
  }

 private:
  const hal::Catalog& catalog_;
  KnownNames known_;
  Problems& problems_;
  Scenario out_;
  std::map<std::string, std::vector<hal::AnyPart>> fitted_;  // by kind
  bool numbered_ = false;
};

// The parts of a file. Each reads one element into `reading.out()`.
void read_framework(Reading& reading, Element& framework);
void read_controllers(Reading& reading, Element& controllers);
void read_engines(Reading& reading, Element& engines);
void read_media(Reading& reading, Element& media);
void read_trackers(Reading& reading, Element& trackers);
/// After the arena: robots are to start where they may be.
void read_safety(Reading& reading, Element& safety);
/// Before the arena.
void read_fitted(Reading& reading, Element& fitted);
/// After the arena, whose robots spares are compared with.
void read_desk(Reading& reading, Element& desk);
void read_arena(Reading& reading, Element& arena);
void read_hook(Reading& reading, Element& loop_functions);
void read_record(Reading& reading, Element& record);
void read_visualization(Reading& reading, Element& visualization);

/// Judges what needs the whole file: that ids are unique, and that the media of lit things are there.
void check_ids(Reading& reading);
void connect_media(Reading& reading);

}  // namespace tandem::core
