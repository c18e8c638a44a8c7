// A piece of an experiment file as plain data: names, attributes, children, and the line of each.
#pragma once
#include <cstddef>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "hal/params.hpp"

namespace tandem::hal {

/// Something wrong in an experiment file. Printed as `file:line: error: message`.
struct Problem {
  std::string file;
  int line = 0;
  std::string message;
  bool warning = false;
  bool ignored = false;  ///< a warning of content of an ARGoS file that nothing reads
};
using Problems = std::vector<Problem>;

/// `file:line: error: message`, or `warning:`.
std::string to_text(const Problem& problem);
/// Whether an error is among the problems from number `first` on.
bool has_errors(const Problems& problems, std::size_t first = 0) noexcept;
/// Of ignored content, each kind of message stays once, with the number of the others.
void count_ignored(Problems& problems);
/// Makes errors of warnings of ignored content.
void refuse_ignored(Problems& problems);

/// Root of the experiment files of ARGoS 3, which ignores unknown content.
inline constexpr std::string_view kArgosRoot = "argos-configuration";

/// An XML element without the XML library.
struct Element {
  struct Attribute {
    std::string name;
    std::string value;
    int line = 0;
    std::string origin = {};  ///< where it was set when not in the file, e.g. "--set framework.experiment.length=5"
  };
  std::string name;
  std::string file;
  int line = 0;
  std::vector<Attribute> attributes;
  std::vector<Element> children;
  std::string text = {};  ///< what stands between the tags, where that belongs to others (<params>)
  bool argos = false;     ///< of a file whose root is `kArgosRoot`

  const std::string* attribute(std::string_view attribute_name) const noexcept;
  const Element* child(std::string_view child_name) const noexcept;
};

/// A problem with an element, or with one of its attributes (named in the message, even when it is not there).
Problem problem_at(const Element& element, std::string message);
Problem problem_at(const Element& element, std::string_view attribute, std::string message);

/// A problem with content that nothing reads: an error; in an ARGoS file a warning.
Problem unread_at(const Element& element, std::string message);
Problem unread_at(const Element& element, std::string_view attribute, std::string message);

/// "a, b, c": at most the first 20, for messages.
std::string listed(const std::vector<std::string>& names);

/// "<parent> cannot hold <child>; it may hold: …", for messages.
std::string cannot_hold(const Element& parent, const Element& child, const std::vector<std::string>& allowed);

/// ". Did you mean 'x'?" with the closest candidate, or empty when none is near.
std::string did_you_mean(std::string_view word, const std::vector<std::string>& candidates);

/// The closest of `candidates` to `word` by edit distance, or empty when none is near: for "did you mean".
std::string closest(std::string_view word, const std::vector<std::string>& candidates);

/// A path as a file names it: relative to the working directory, or else to the folder of that file.
std::string path_beside(const std::string& path, const std::string& file);

/// Fills described parameters from an element's attributes, groups and lists of them from its children. Every one must
/// be asked for, else it is unknown: call `finish()` after `describe` to have unknown ones reported with "did you
/// mean".
class ElementReader final : public ParamVisitor {
 public:
  /// `ignore` are attributes that belong to others (e.g. "id", "library", "implementation"), `ignore_children`
  /// elements that do.
  ElementReader(const Element& element, Problems& problems, std::vector<std::string> ignore = {},
                std::vector<std::string> ignore_children = {});

  void visit(const Param& param) override;
  void finish();
  /// For elements whose children belong to others.
  void finish_attributes();

 private:
  void read(const Param& param, const std::string& text, double& value);
  void read(const Param& param, const std::string& text, std::int64_t& value);
  void read(const Param& param, const std::string& text, bool& value);
  void read(const Param& param, const std::string& text, std::array<double, 3>& value);
  void read(const Param& param, const std::string& text, Interval& value);
  void read(const Param& param, const std::string& text, const Param::Choice& choice);
  void read_group(std::string_view name, const Param::Group& group);
  void read_list(std::string_view name, ParamList& list);
  void take_others(std::string& value);
  void problem(std::string_view attribute, std::string message);
  /// Whether `value` lies in `range`; says so when not.
  bool in_range(std::string_view name, const std::string& text, double value, Range range, const Unit& unit);

  const Element& element_;
  Problems& problems_;
  std::vector<std::string> known_, known_children_;
};

/// Reads all that an element says of a described struct. `ignore` and `ignore_children` as ElementReader has them.
template <Described T>
T read_settings(const Element& element, Problems& problems, std::vector<std::string> ignore = {},
                std::vector<std::string> ignore_children = {}) {
  T value{};
  ElementReader reader(element, problems, std::move(ignore), std::move(ignore_children));
  value.describe(reader);
  reader.finish();
  return value;
}

/// Completes an element with what a described struct has and the file left out, attributes and groups: the effective
/// settings. Numbers are written so that they read back as the same bits.
class ElementWriter final : public ParamVisitor {
 public:
  explicit ElementWriter(Element& element) : element_(element) {}

  void visit(const Param& param) override;

 private:
  Element& add_child(std::string_view name);
  Element& element_;
};

/// Lists described parameters for people, one a line: name, default, range, what it means.
class ManualWriter final : public ParamVisitor {
 public:
  void visit(const Param& param) override;

  const std::string& text() const noexcept { return text_; }

 private:
  std::string text_;
  std::string indent_ = "  ";
};

/// Lists described values for people, one a line: name, value, what it means. Structs of a list take one line each.
class FactWriter final : public ParamVisitor {
 public:
  void visit(const Param& param) override;

  const std::string& text() const noexcept { return text_; }

 private:
  std::string text_;
  std::string indent_ = "  ";
  bool in_line_ = false;
};

}  // namespace tandem::hal
