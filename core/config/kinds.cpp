#include "core/config/kinds.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <set>
#include <span>
#include <string_view>
#include <utility>
#include <variant>

#include "core/config/reader.hpp"
#include "core/config/reading.hpp"
#include "core/config/upgrade.hpp"
#include "hal/xml/xml.hpp"

namespace tandem::core {
namespace {

namespace fs = std::filesystem;
using hal::ParamVisitor;
using hal::Range;
using hal::Unit;

constexpr std::size_t kLongestName = 64;

bool is_kinds(const Element& e) {
  return e.name == schema::Kinds::kElement.name;
}

/// "file:line" for messages that are about another line.
std::string place_of(const Element& e, const Element& seen_from) {
  return (e.file == seen_from.file ? "line " : e.file + ":") + std::to_string(e.line);
}

// --- files that are included ---

class Inclusion {
 public:
  explicit Inclusion(Problems& problems) : problems_(problems) {}

  /// What <kinds> holds, with the contents of files that it names, to the end of `out`.
  void expand(const Element& kinds, std::vector<Element>& out) {
    check_attributes(kinds);
    const std::string* const file = kinds.attribute("file");
    if (file == nullptr) {
      for (const Element& child : kinds.children) {
        if (is_kinds(child))
          expand(child, out);
        else
          out.push_back(child);
      }
      return;
    }
    if (!kinds.children.empty())
      problems_.push_back(problem_at(kinds, "file",
                                     "the element names a file, and holds elements, too; give each its "
                                     "own <kinds>"));
    include(kinds, *file, out);
  }

  /// The file itself is being read.
  void enter(const std::string& path) { open_.push_back(path); }

 private:
  static std::string canonical(const std::string& path) {
    std::error_code ignored;
    return fs::weakly_canonical(path, ignored).string();
  }

  static std::string beside(const std::string& path, const std::string& file) {
    std::error_code ignored;
    if (fs::path(path).is_absolute()) return path;
    const fs::path there = fs::path(file).parent_path() / path;
    return fs::exists(there, ignored) || !fs::exists(path, ignored) ? there.string() : path;
  }

  void check_attributes(const Element& kinds) {
    schema::Kinds attributes;
    ElementReader reader(kinds, problems_);
    attributes.describe(reader);
    reader.finish_attributes();
    if (const std::string why = version_problem(attributes.version); !why.empty())
      problems_.push_back(problem_at(kinds, "version", why));
  }

  void include(const Element& e, const std::string& name, std::vector<Element>& out) {
    if (name.empty()) {
      problems_.push_back(problem_at(e, "file", "must not be empty"));
      return;
    }
    const std::string path = beside(name, e.file);
    const std::string key = canonical(path);
    const auto same = [&](const std::string& other) { return canonical(other) == key; };
    if (const auto first = std::find_if(open_.begin(), open_.end(), same); first != open_.end()) {
      std::string way;
      for (auto at = first; at != open_.end(); ++at) way += *at + " -> ";
      problems_.push_back(problem_at(e, "file", "the file includes itself: " + way + path + "; leave this out"));
      return;
    }
    if (!seen_.insert(key).second) return;
    Problems found;
    const auto root = hal::read_xml_file(path, found);
    if (!root) {
      for (Problem& problem : found) {
        if (problem.line == 0)  // of the file as a whole: where it is named tells more
          problem = problem_at(e, "file", "'" + path + "': " + problem.message);
      }
    }
    problems_.insert(problems_.end(), found.begin(), found.end());
    if (!root) return;
    if (!is_kinds(*root)) {
      problems_.push_back(
          problem_at(*root, "the root element is <" + root->name + ">; a file of kinds of robots starts with <kinds>"));
      return;
    }
    open_.push_back(path);
    expand(*root, out);
    open_.pop_back();
  }

  Problems& problems_;
  std::vector<std::string> open_;  // paths, from the outermost to the one that is being read
  std::set<std::string> seen_;     // canonical paths
};

// --- kinds ---

/// Notes described numbers that are out of their own range: those without a sensible default, which a file has to give.
class Missing final : public ParamVisitor {
 public:
  Missing(const Element& element, Problems& problems) : element_(element), problems_(problems) {}

  void visit(const hal::Param& param) override {
    if (const auto* const group = param.group(); group != nullptr) {
      const Element* const child = element_.child(param.name);
      Missing inner(child != nullptr ? *child : element_, problems_);
      group->describe(group->value, inner);
    }
    if (const auto* const number = param.as<double>(); number != nullptr) judge(param, *number);
    if (const auto* const whole = param.as<std::int64_t>(); whole != nullptr) judge(param, static_cast<double>(*whole));
  }

 private:
  void judge(const hal::Param& param, double value) {
    const auto& [least, most] = param.range;
    if ((value >= least && value <= most) || element_.attribute(param.name) != nullptr) return;
    problems_.push_back(problem_at(element_, "<" + element_.name + "> needs the attribute '" + std::string(param.name) +
                                                 "': " + std::string(param.doc)));
  }

  const Element& element_;
  Problems& problems_;
};

/// The drives, in the order of hal::Locomotion.
constexpr std::array<std::string_view, 2> kDrives = {hal::DifferentialDrive::kName, hal::Quadrotor::kName};

bool is_drive(std::string_view name) {
  return std::find(kDrives.begin(), kDrives.end(), name) != kDrives.end();
}

std::string_view drive_name(const hal::RobotKind& kind) {
  return kind.drive() != nullptr ? kDrives[0] : kind.flies() ? kDrives[1] : std::string_view();
}

void set_drive(hal::RobotKind& kind, std::string_view name) {
  if (name == drive_name(kind)) return;
  if (name == kDrives[0]) kind.locomotion = hal::DifferentialDrive{};
  if (name == kDrives[1]) kind.locomotion = hal::Quadrotor{};
}

/// What an element says of a kind's own, and of its parts.
struct WholeKind : schema::Kind {
  hal::RobotKind& kind;
  void describe(ParamVisitor& v) {
    schema::Kind::describe(v);
    kind.describe(v);
  }
};

class KindsReader {
 public:
  KindsReader(const std::vector<Element>& elements, const hal::Catalog& catalog, Problems& problems)
      : catalog_(catalog), problems_(problems) {
    for (const hal::PartType* type : catalog.all<hal::PartType>()) parts_.emplace_back(type->name);
    for (const Element& e : elements) {
      if (e.name != schema::Kind::kElement.name)
        error(e, "<kinds> cannot hold <" + e.name + ">; it may hold: kind, kinds");
      else if (const std::string* name = e.attribute("name"); name == nullptr || name->empty())
        error(e, "<kind> needs the attribute 'name'");
      else if (const Draft* const other = find(*name); other != nullptr)
        error(e, "a second kind '" + *name + "'; the first is on " + place_of(other->element, e) +
                     "; give one of them another name");
      else if (good_name(e, *name))
        drafts_.push_back({e, *name, {}, {}, State::Waiting});
    }
  }

  std::vector<KindConfig> read() {
    std::vector<KindConfig> all;
    for (Draft& draft : drafts_) make(draft);
    for (Draft& draft : drafts_)
      all.push_back({std::make_shared<const hal::RobotKind>(std::move(draft.kind)), draft.bridge, draft.element.file,
                     draft.element.line});
    return all;
  }

 private:
  enum class State { Waiting, Making, Made };
  struct Draft {
    const Element& element;
    std::string name;
    hal::RobotKind kind;
    std::string bridge;
    State state;
  };

  void error(const Element& e, std::string message) { problems_.push_back(problem_at(e, std::move(message))); }
  void error(const Element& e, std::string_view attribute, std::string message) {
    problems_.push_back(problem_at(e, attribute, std::move(message)));
  }
  Draft* find(std::string_view name) {
    const auto found = std::find_if(drafts_.begin(), drafts_.end(), [&](const Draft& d) { return d.name == name; });
    return found == drafts_.end() ? nullptr : &*found;
  }
  std::vector<std::string> robots() const {
    std::vector<std::string> names = catalog_.names(hal::RobotKind::kCategory);
    for (const Draft& draft : drafts_) names.push_back(draft.name);
    return names;
  }

  bool good_name(const Element& e, const std::string& name) {
    const auto letter = [](unsigned char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); };
    const auto fits = [&](unsigned char c) { return letter(c) || (c >= '0' && c <= '9') || c == '-' || c == '_'; };
    if (name.size() > kLongestName || !letter(static_cast<unsigned char>(name[0])) ||
        !std::all_of(name.begin(), name.end(), fits)) {
      error(e, "name",
            "'" + name.substr(0, kLongestName) +
                "' cannot be the name of an element; use at most 64 letters, digits, '-' and '_', a letter first");
      return false;
    }
    if (const auto* const known = catalog_.find<hal::RobotKind>(name); known != nullptr) {
      error(e, "name",
            "there is a robot '" + name + "' already, from " + catalog_.origin_of(known) +
                "; give yours another name, and like=\"" + name + "\" to begin from that one");
      return false;
    }
    if (elements_.empty()) elements_ = element_names(KnownNames(catalog_));
    if (!elements_.contains(name)) return true;
    error(e, "name", "'" + name + "' is another element of experiment files; choose another name");
    return false;
  }

  void make(Draft& draft) {
    if (draft.state == State::Made) return;
    draft.state = State::Making;
    const std::size_t first_problem = problems_.size();
    const Element& e = draft.element;
    const bool begun = begin(draft);
    leave_out(draft);
    add_parts(draft.kind, e);
    WholeKind whole{{}, draft.kind};
    ElementReader reader(e, problems_, {}, strangers_);
    whole.describe(reader);
    reader.finish();
    draft.kind.name = draft.name;
    if (e.attribute("summary") != nullptr) draft.kind.summary = whole.summary;
    if (draft.kind.summary.empty()) draft.kind.summary = "A kind of robot from a file.";
    read_bridge(draft);
    if (begun) judge(draft, first_problem);
    if (has_errors(problems_, first_problem)) make_harmless(draft.kind);
    draft.state = State::Made;
  }

  /// From the kind that it is like. False: that cannot be.
  bool begin(Draft& draft) {
    const Element& e = draft.element;
    const std::string* const like = e.attribute("like");
    if (like == nullptr || like->empty()) return true;
    if (Draft* const other = find(*like); other != nullptr) {
      if (other->state == State::Making) {
        error(e, "like", circle(draft, *other));
        return false;
      }
      make(*other);
      draft.kind = other->kind;
      draft.bridge = other->bridge;
    } else if (const auto* const known = catalog_.find<hal::RobotKind>(*like); known != nullptr) {
      draft.kind = *known;
      draft.bridge = known->name;
    } else {
      error(e, "like",
            "there is no robot '" + *like + "'; there are: " + listed(robots()) + did_you_mean(*like, robots()));
      return false;
    }
    return true;
  }

  std::string circle(const Draft& draft, const Draft& first) {
    std::string way = "'" + first.name + "'";
    const Draft* at = &first;
    do {
      at = find(*at->element.attribute("like"));
      way += " is like '" + at->name + "'" + (at->name == first.name ? "" : ", which");
    } while (at != &first && at->name != first.name);
    return "'" + draft.name + "' cannot begin from itself: " + way + "; leave one of them out";
  }

  void leave_out(Draft& draft) {
    const std::string* const without = draft.element.attribute("without");
    if (without == nullptr) return;
    for (const std::string& name : words(*without)) {
      if (name.empty()) continue;
      if (name == drive_name(draft.kind)) {
        draft.kind.locomotion = {};
      } else if (!draft.kind.remove(name)) {
        std::vector<std::string> has;
        if (const std::string_view drive = drive_name(draft.kind); !drive.empty()) has.emplace_back(drive);
        for (const hal::AnyPart& part : std::as_const(draft.kind).parts()) has.emplace_back(part.name());
        error(draft.element, "without",
              "there is no '" + name + "' to leave out; there is: " + listed(has) + did_you_mean(name, has));
      }
    }
  }

  /// The parts and the drive that the element names, with their defaults where the kind has none. What it cannot hold
  /// is in `strangers_`.
  void add_parts(hal::RobotKind& kind, const Element& e) {
    strangers_.clear();
    const Element* drive = nullptr;
    for (const Element& child : e.children) {
      if (child.name == hal::Body::kName) continue;
      if (is_drive(child.name)) {
        if (drive != nullptr && drive->name != child.name)
          error(child, "a second drive <" + child.name + ">; the first is <" + drive->name + "> on " +
                           place_of(*drive, child));
        drive = drive != nullptr ? drive : &child;
        set_drive(kind, drive->name);
        if (drive->name != child.name) strangers_.push_back(child.name);
        continue;
      }
      const auto& has = std::as_const(kind).parts();
      if (std::any_of(has.begin(), has.end(), [&](const hal::AnyPart& p) { return p.name() == child.name; })) continue;
      if (const auto* const type = catalog_.find<hal::PartType>(child.name); type != nullptr) {
        kind.add(type->make());
      } else {
        strangers_.push_back(child.name);
        error(child, unknown(child.name));
      }
    }
  }

  std::string unknown(const std::string& name) const {
    std::vector<std::string> all{std::string(hal::Body::kName)};
    for (const std::string_view drive : kDrives) all.emplace_back(drive);
    all.insert(all.end(), parts_.begin(), parts_.end());
    std::string known;
    for (const std::string& part : parts_) known += (known.empty() ? "" : ", ") + part;
    return "<kind> cannot hold <" + name + ">: it is no body, no drive that engines know (" + std::string(kDrives[0]) +
           ", " + std::string(kDrives[1]) + ") and no part (" + known +
           "; those of a plug-in need its <plugins library=\"…\"/>)" + did_you_mean(name, all);
  }

  void read_bridge(Draft& draft) {
    const std::string* const bridge = draft.element.attribute("bridge");
    if (bridge == nullptr) return;
    draft.bridge = *bridge;
    if (bridge->empty() || *bridge == draft.name || catalog_.find<hal::RobotKind>(*bridge) != nullptr) return;
    const std::vector<std::string> known = catalog_.names(hal::RobotKind::kCategory);
    error(draft.element, "bridge",
          "there is no robot '" + *bridge + "'; there are: " + listed(known) + did_you_mean(*bridge, known));
  }

  /// What the reader of attributes cannot see: figures that are not there, and what does not go together.
  void judge(Draft& draft, std::size_t first_problem) {
    hal::RobotKind& kind = draft.kind;
    const Element& e = draft.element;
    const auto element_for = [&](std::string_view name) -> const Element& {
      const Element* const child = e.child(name);
      return child != nullptr ? *child : e;
    };
    if (e.child(hal::Body::kName) == nullptr && !(kind.body.radius_m > 0.0)) {
      error(e, "the kind '" + draft.name + "' has no body; give it a <body radius=\"…\" height=\"…\" mass=\"…\"/>");
    } else {
      Missing missing(element_for(hal::Body::kName), problems_);
      kind.body.describe(missing);
    }
    if (const std::string_view drive = drive_name(kind); !drive.empty()) {
      Missing missing(element_for(drive), problems_);
      std::visit(
          [&](auto& how) {
            if constexpr (requires { how.describe(missing); }) how.describe(missing);
          },
          kind.locomotion);
    }
    for (hal::AnyPart& part : kind.parts()) {
      Missing missing(element_for(part.name()), problems_);
      part.describe(missing);
      if (const std::string flaw = part.flaw(); !flaw.empty())
        error(element_for(part.name()), "<" + std::string(part.name()) + "> " + flaw);
    }
    if (has_errors(problems_, first_problem)) return;
    if (const std::string flaw = kind.flaw(); !flaw.empty()) error(e, "the kind '" + draft.name + "' " + flaw);
  }

  /// So that the catalog takes it, and the rest of the file can be read: the file is refused anyway.
  static void make_harmless(hal::RobotKind& kind) {
    kind.body = {.radius_m = 0.1, .height_m = 0.1, .mass_kg = 1.0};
    if (const auto* drive = kind.drive(); drive != nullptr && !(drive->wheel_base_m > 0.0)) kind.locomotion = {};
    std::vector<std::string> flawed;
    for (const hal::AnyPart& part : kind.parts()) {
      if (!part.flaw().empty()) flawed.emplace_back(part.name());
    }
    for (const std::string& name : flawed) kind.remove(name);
    if (kind.flaw().empty()) return;
    hal::RobotKind bare;
    bare.name = kind.name;
    bare.summary = kind.summary;
    bare.body = kind.body;
    kind = std::move(bare);
  }

  const hal::Catalog& catalog_;
  Problems& problems_;
  std::vector<std::string> parts_;
  std::set<std::string> elements_;  // of experiment files; looked up when there is a kind
  std::vector<Draft> drafts_;
  std::vector<std::string> strangers_;
};

}  // namespace

void include_kinds(Element& root, Problems& problems) {
  Inclusion inclusion(problems);
  inclusion.enter(root.file);
  if (is_kinds(root)) {
    std::vector<Element> all;
    inclusion.expand(root, all);
    root.children = std::move(all);
    return;
  }
  const auto first = std::find_if(root.children.begin(), root.children.end(), is_kinds);
  if (first == root.children.end()) return;
  Element kinds = *first;
  kinds.attributes.clear();
  kinds.children.clear();
  for (const Element& e : root.children) {
    if (is_kinds(e)) inclusion.expand(e, kinds.children);
  }
  *first = std::move(kinds);
  root.children.erase(std::remove_if(std::next(first), root.children.end(), is_kinds), root.children.end());
}

std::vector<KindConfig> read_kinds(Element& root, const hal::Catalog& catalog, Problems& problems) {
  const auto found = std::find_if(root.children.begin(), root.children.end(), is_kinds);
  Element* const kinds = is_kinds(root) ? &root : found == root.children.end() ? nullptr : &*found;
  if (kinds == nullptr) return {};
  const std::vector<Element> elements = std::move(kinds->children);
  std::vector<KindConfig> all = KindsReader(elements, catalog, problems).read();
  kinds->children.clear();
  for (const KindConfig& config : all) {
    kinds->children.push_back(element_of(*config.kind, config.bridge));
    kinds->children.back().file = config.file;
    kinds->children.back().line = config.line;
  }
  return all;
}

std::optional<std::vector<KindConfig>> read_kinds_file(const std::string& path, const hal::Catalog& catalog,
                                                       Problems& problems) {
  const std::size_t first = problems.size();
  auto root = hal::read_xml_file(path, problems);
  if (!root) return std::nullopt;
  if (!is_kinds(*root)) {
    problems.push_back(
        problem_at(*root, "the root element is <" + root->name + ">; a file of kinds of robots starts with <kinds>"));
    return std::nullopt;
  }
  include_kinds(*root, problems);
  auto kinds = read_kinds(*root, catalog, problems);
  if (has_errors(problems, first)) return std::nullopt;
  return kinds;
}

Element element_of(const hal::RobotKind& kind, const std::string& bridge) {
  Element element;
  element.name = schema::Kind::kElement.name;
  element.attributes = {{"name", kind.name, 0}, {"summary", kind.summary, 0}};
  if (!bridge.empty()) element.attributes.push_back({"bridge", bridge, 0});
  hal::RobotKind shown = kind;
  ElementWriter writer(element);
  shown.describe(writer);
  return element;
}

std::string kinds_file(const std::vector<Element>& kinds) {
  Element root;
  root.name = schema::Kinds::kElement.name;
  root.attributes = {{"version", std::to_string(kFileVersion), 0}};
  root.children = kinds;
  return hal::to_xml(root);
}

}  // namespace tandem::core
