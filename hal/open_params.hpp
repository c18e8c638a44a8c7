// Parameters of classes that take whatever their file says, such as scripts: beside the described ones, all others.
//
// These go through ParamVisitor under names that no file can have, so that visitors that know nothing of it need not:
// the reader of experiment files answers, the manual names it, others leave it alone.
#pragma once
#include <string>
#include <string_view>
#include <vector>

#include "hal/params.hpp"

namespace tandem::hal {

/// Text parameter for which the reader gives all that nothing else asked for: "name\nvalue\n…", a line each.
inline constexpr std::string_view kOtherParams = "*";
/// Text parameter that the reader makes a path that can be opened, where it names one relative to the file.
inline constexpr std::string_view kPathParam = "*path";
/// Flag that the reader sets where the file's root is ARGoS': a description may then begin with other defaults.
inline constexpr std::string_view kArgosParam = "*argos";
/// Text parameter for which the reader gives the whole element, children and all, as XML.
inline constexpr std::string_view kWholeElement = "**";

constexpr bool is_no_attribute(std::string_view name) noexcept {
  return name == kOtherParams || name == kPathParam || name == kArgosParam || name == kWholeElement;
}

/// Whether the description is of an element of an ARGoS file; before the parameters whose defaults depend on it.
inline bool in_argos_file(ParamVisitor& v) {
  bool argos = false;
  v.flag(kArgosParam, argos, "");
  return argos;
}

/// A parameter that only its user knows.
struct NamedText {
  std::string name, value;
};

/// Describes what else stands there; after all other parameters. A class that does so has no unknown ones.
inline void describe_others(ParamVisitor& v, std::vector<NamedText>& values, std::string_view doc) {
  std::string lines;
  v.text(kOtherParams, lines, doc);
  for (std::size_t at = 0; at < lines.size();) {
    const std::size_t middle = lines.find('\n', at);
    const std::size_t end = lines.find('\n', middle + 1);
    values.push_back({lines.substr(at, middle - at), lines.substr(middle + 1, end - middle - 1)});
    at = end + 1;
  }
}

/// Describes a file that is read besides: relative to the working directory, or else to the folder of the experiment.
inline void describe_file(ParamVisitor& v, std::string_view name, std::string& path, std::string_view doc) {
  v.text(name, path, doc);
  v.text(kPathParam, path, doc);
}

/// Describes the element itself, as XML text, for classes that read it in their own way: none of its attributes and
/// children is unknown then. Empty where nothing was read.
inline void describe_element(ParamVisitor& v, std::string& xml, std::string_view doc) {
  v.text(kWholeElement, xml, doc);
}

}  // namespace tandem::hal
