// A look at whether a document is well-formed XML, as far as tags, attributes and entities go.
#pragma once
#include <algorithm>
#include <regex>
#include <string>
#include <vector>

namespace tandem::core {

/// Empty, or what is wrong and where.
inline std::string why_not_well_formed(const std::string& xml) {
  static const std::regex kTag(R"re(^(/?)([A-Za-z][\w:-]*)((?:\s+[A-Za-z][\w:-]*="[^"<&]*")*)\s*(/?)$)re");
  std::vector<std::string> open;
  bool root_seen = false;
  std::size_t at = 0;
  if (xml.compare(0, 5, "<?xml") == 0) at = xml.find("?>") + 2;
  while (at < xml.size()) {
    const std::size_t lt = std::min(xml.find('<', at), xml.size());
    const std::string text = xml.substr(at, lt - at);
    if (open.empty() && text.find_first_not_of(" \n") != std::string::npos) return "text outside the root: " + text;
    for (std::size_t amp = text.find('&'); amp != std::string::npos; amp = text.find('&', amp + 1)) {
      if (!std::regex_search(text.substr(amp, 8), std::regex("^&(amp|lt|gt|quot);"))) return "bare '&' in: " + text;
    }
    if (lt == xml.size()) break;
    const std::size_t gt = xml.find('>', lt);
    if (gt == std::string::npos) return "a tag that does not end";
    at = gt + 1;
    const std::string inside = xml.substr(lt + 1, gt - lt - 1);
    if (inside.size() > 4'000) {  // beyond what a regular expression can take; such paths hold numbers only
      if (inside.back() != '/') return "a long tag that is not closed";
      continue;
    }
    std::smatch match;
    if (!std::regex_match(inside, match, kTag)) return "malformed tag <" + inside + ">";
    if (match[1] == "/") {
      if (open.empty() || open.back() != match[2]) return "unexpected </" + match[2].str() + ">";
      open.pop_back();
    } else if (match[4] != "/") {
      if (open.empty() && root_seen) return "second root <" + match[2].str() + ">";
      root_seen = true;
      open.push_back(match[2]);
    }
  }
  if (!open.empty()) return "<" + open.back() + "> is never closed";
  return root_seen ? "" : "no root";
}

}  // namespace tandem::core
