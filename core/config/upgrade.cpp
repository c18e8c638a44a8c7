#include "core/config/upgrade.hpp"

#include <algorithm>
#include <cctype>
#include <cstddef>
#include <optional>
#include <string_view>

#include "core/config/reader.hpp"
#include "hal/xml/xml.hpp"

namespace tandem::core {
namespace {

/// A tag of well-formed XML, by its places in the text.
struct Tag {
  enum class Kind : std::uint8_t { Start, End, Whole };
  struct Attribute {
    std::string_view name, value;
  };
  Kind kind = Kind::Start;
  std::string_view name;
  std::vector<Attribute> attributes;
};

bool is_space(char c) {
  return c == ' ' || c == '\t' || c == '\r' || c == '\n';
}

/// Walks over the tags of a text that an XML parser has accepted.
class Tags {
 public:
  explicit Tags(std::string_view text) : text_(text) {}

  std::optional<Tag> next() {
    while ((at_ = text_.find('<', at_)) != std::string_view::npos) {
      if (skip("<!--", "-->") || skip("<![CDATA[", "]]>") || skip("<?", "?>") || skip("<!", ">")) continue;
      return read();
    }
    return std::nullopt;
  }

 private:
  bool skip(std::string_view begin, std::string_view end) {
    if (!text_.substr(at_).starts_with(begin)) return false;
    const std::size_t found = text_.find(end, at_ + begin.size());
    at_ = found == std::string_view::npos ? text_.size() : found + end.size();
    return true;
  }

  std::string_view word() {
    const std::size_t begin = at_;
    while (at_ < text_.size() && !is_space(text_[at_]) && text_[at_] != '=' && text_[at_] != '/' && text_[at_] != '>')
      ++at_;
    return text_.substr(begin, at_ - begin);
  }
  void skip_space() {
    while (at_ < text_.size() && is_space(text_[at_])) ++at_;
  }

  Tag read() {
    Tag tag;
    ++at_;
    if (at_ < text_.size() && text_[at_] == '/') {
      tag.kind = Tag::Kind::End;
      ++at_;
    }
    tag.name = word();
    for (skip_space(); at_ < text_.size() && text_[at_] != '>'; skip_space()) {
      if (text_[at_] == '/') {
        tag.kind = Tag::Kind::Whole;
        ++at_;
        continue;
      }
      Tag::Attribute attribute{word(), {}};
      skip_space();
      if (at_ >= text_.size() || text_[at_] != '=') continue;
      ++at_;
      skip_space();
      const char quote = at_ < text_.size() ? text_[at_++] : '"';
      const std::size_t end = std::min(text_.find(quote, at_), text_.size());
      attribute.value = text_.substr(at_, end - at_);
      at_ = std::min(end + 1, text_.size());
      tag.attributes.push_back(attribute);
    }
    return tag;
  }

  std::string_view text_;
  std::size_t at_ = 0;
};

/// Replaces pieces of a text, from its beginning to its end.
class Edits {
 public:
  explicit Edits(const std::string& text) : text_(text) {}

  void replace(std::string_view piece, std::string_view by) {
    out_.append(text_, done_, offset(piece) - done_);
    out_ += by;
    done_ = offset(piece) + piece.size();
  }
  void insert_behind(std::string_view piece, std::string_view what) { replace(piece.substr(piece.size()), what); }
  void note(std::string_view piece, std::string what) {
    const auto end = text_.begin() + static_cast<std::ptrdiff_t>(offset(piece));
    changes_.push_back("line " + std::to_string(1 + std::count(text_.begin(), end, '\n')) + ": " + std::move(what));
  }
  Upgrade take() {
    out_.append(text_, done_);
    return {std::move(out_), std::move(changes_)};
  }

 private:
  std::size_t offset(std::string_view piece) const { return static_cast<std::size_t>(piece.data() - text_.data()); }

  const std::string& text_;
  std::string out_;
  std::size_t done_ = 0;
  std::vector<std::string> changes_;
};

std::int64_t version_of(const Element& root) {
  const std::string* said = root.attribute("version");
  if (said == nullptr || said->empty() || said->size() > 9 ||
      !std::all_of(said->begin(), said->end(), [](unsigned char c) { return std::isdigit(c) != 0; }))
    return 0;
  return std::stoll(*said);
}

/// To version 1: ARGoS' names of the root and of devices become Tandem's.
Upgrade to_version_1(const std::string& text, const hal::Catalog& catalog) {
  Edits edits(text);
  std::vector<std::string> path;
  Tags tags(text);
  while (const std::optional<Tag> tag = tags.next()) {
    if (tag->kind == Tag::Kind::End && !path.empty()) path.pop_back();
    const std::size_t depth = path.size();  // of what the tag stands in
    // <tandem><controllers><configuration><sensors><device>
    const bool device = depth == 4 && path[1] == "controllers" && (path[3] == "sensors" || path[3] == "actuators");
    if (depth == 0) {
      if (tag->name == "argos-configuration") {
        if (tag->kind != Tag::Kind::End)
          edits.note(tag->name,
                     "<argos-configuration> is now <tandem>, whose defaults are others: see docs/from-argos.md");
        edits.replace(tag->name, "tandem");
      }
      if (tag->kind != Tag::Kind::End) {
        const auto said = std::find_if(tag->attributes.begin(), tag->attributes.end(),
                                       [](const Tag::Attribute& a) { return a.name == "version"; });
        edits.note(tag->name, "it says that it is of version 1");
        if (said != tag->attributes.end())
          edits.replace(said->value, "1");
        else
          edits.insert_behind(tag->name, " version=\"1\"");
      }
    } else if (device) {
      const hal::Role role = path[3] == "sensors" ? hal::Role::Sensor : hal::Role::Actuator;
      if (const std::string name = device_name(tag->name, role, catalog); name != tag->name) {
        if (tag->kind != Tag::Kind::End)
          edits.note(tag->name, "<" + std::string(tag->name) + "> is now <" + name + ">");
        edits.replace(tag->name, name);
      }
    }
    if (tag->kind == Tag::Kind::Start) path.emplace_back(tag->name);
  }
  return edits.take();
}

}  // namespace

std::string version_problem(std::int64_t version) {
  if (version <= kFileVersion) return {};
  return "the file is of version " + std::to_string(version) + ", and this program knows files up to version " +
         std::to_string(kFileVersion) + "; use a later program";
}

hal::Result<Upgrade> upgraded(const std::string& text, const std::string& name, const hal::Catalog& catalog) {
  Problems problems;
  const std::optional<Element> root = hal::read_xml_text(text, name, problems);
  if (!root) return hal::Error{to_text(problems.front())};
  const bool kinds = root->name == "kinds";
  if (!kinds && root->name != "tandem" && root->name != "argos-configuration")
    return hal::Error{name + ": the root element is <" + root->name + ">: this is no experiment"};
  const std::int64_t version = version_of(*root);
  if (const std::string why = version_problem(version); !why.empty()) return hal::Error{name + ": " + why};
  if (kinds || version >= 1) return Upgrade{text, {}};
  return to_version_1(text, catalog);
}

}  // namespace tandem::core
