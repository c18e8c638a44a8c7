#include "hal/xml/xml.hpp"

#include <algorithm>
#include <tinyxml2.h>

#include "hal/input_file.hpp"

namespace tandem::hal {
namespace {

constexpr std::uintmax_t kLargestFile = 64U << 20U;

class Converter {
 public:
  Converter(const std::string& file, Problems& problems) : file_(file), problems_(problems) {}

  /// `free`: somebody else's content, in which text may stand.
  Element convert(const tinyxml2::XMLElement& from, bool free, bool argos) {
    Element element;
    element.argos = argos;
    element.name = from.Name();
    element.file = file_;
    element.line = from.GetLineNum();
    free = free || element.name == "params" || element.name == "loop_functions" || element.name == "visualization";
    for (const auto* a = from.FirstAttribute(); a != nullptr; a = a->Next()) {
      element.attributes.push_back({a->Name(), a->Value(), a->GetLineNum()});
    }
    for (const auto* node = from.FirstChild(); node != nullptr; node = node->NextSibling()) {
      if (const auto* child = node->ToElement(); child != nullptr) {
        element.children.push_back(convert(*child, free, argos));
      } else if (node->ToText() != nullptr && free) {
        element.text += node->Value();
      } else if (node->ToText() != nullptr) {
        const std::string text = node->Value();
        Problem unread = unread_at(element, "<" + element.name + "> holds the text '" + text.substr(0, 30) +
                                                "', which means nothing; values stand in attributes, comments in "
                                                "<!-- -->");
        unread.line = node->GetLineNum();
        problems_.push_back(std::move(unread));
      }
    }
    return element;
  }

  void problem(int line, std::string message) { problems_.push_back({file_, line, std::move(message)}); }

 private:
  const std::string& file_;
  Problems& problems_;
};

void print(const Element& element, tinyxml2::XMLPrinter& printer) {
  printer.OpenElement(element.name.c_str());
  for (const Element::Attribute& a : element.attributes) printer.PushAttribute(a.name.c_str(), a.value.c_str());
  if (!element.text.empty()) printer.PushText(element.text.c_str());
  for (const Element& child : element.children) print(child, printer);
  printer.CloseElement();
}

/// An element that is open.
struct Open {
  std::string name;
  int line = 0;
};

/// Walks over the tags of a text that is XML but for their order.
class Tags {
 public:
  explicit Tags(const std::string& text) : text_(text) {}

  /// The element that is not closed where it should be, and what stands there instead; line 0: all are.
  std::pair<Open, std::string> unclosed() {
    std::vector<Open> open;
    while ((at_ = text_.find('<', at_)) != std::string::npos) {
      if (skip("<!--", "-->") || skip("<![CDATA[", "]]>") || skip("<?", "?>") || skip("<!", ">")) continue;
      const int line = 1 + static_cast<int>(std::count(text_.begin(), text_.begin() + here(at_), '\n'));
      const bool closes = text_.compare(at_, 2, "</") == 0;
      const std::string name = next_name(at_ + (closes ? 2 : 1));
      const bool whole = pass_tag();
      if (!closes && !whole) open.push_back({name, line});
      if (!closes) continue;
      if (open.empty()) return {};
      if (open.back().name != name) return {open.back(), "line " + std::to_string(line) + " closes <" + name + ">"};
      open.pop_back();
    }
    if (open.empty()) return {};
    return {open.back(), "the file ends"};
  }

 private:
  static std::ptrdiff_t here(std::size_t at) { return static_cast<std::ptrdiff_t>(at); }
  bool skip(std::string_view begin, std::string_view end) {
    if (text_.compare(at_, begin.size(), begin) != 0) return false;
    at_ = std::min(text_.find(end, at_ + begin.size()), text_.size());
    return true;
  }
  std::string next_name(std::size_t from) const {
    return text_.substr(from, std::min(text_.find_first_of(" \t\r\n/>", from), text_.size()) - from);
  }
  /// Goes behind the tag. @returns whether it closes itself.
  bool pass_tag() {
    char quote = 0;
    for (; at_ < text_.size() && (quote != 0 || text_[at_] != '>'); ++at_) {
      const char c = text_[at_];
      if (quote == 0 ? c == '"' || c == '\'' : c == quote) quote = quote == 0 ? c : '\0';
    }
    return at_ > 0 && at_ < text_.size() && text_[at_ - 1] == '/';
  }

  const std::string& text_;
  std::size_t at_ = 0;
};

std::string why_not_xml(const tinyxml2::XMLDocument& document) {
  switch (document.ErrorID()) {
    case tinyxml2::XML_ERROR_EMPTY_DOCUMENT:
      return "the file is empty";
    case tinyxml2::XML_ERROR_PARSING_ATTRIBUTE:
      return "not well-formed XML: an attribute must be written name=\"value\", and only once";
    case tinyxml2::XML_ERROR_PARSING_COMMENT:
      return "not well-formed XML: a comment <!-- is never closed with -->";
    case tinyxml2::XML_ERROR_PARSING_TEXT:
      return "not well-formed XML: there is text outside of the elements; is this an XML file?";
    case tinyxml2::XML_ELEMENT_DEPTH_EXCEEDED:
      return "the elements are nested too deeply";
    case tinyxml2::XML_ERROR_PARSING_ELEMENT:
      return "not well-formed XML: a tag is broken or never closed with >";
    default:
      return std::string("not well-formed XML: ") + document.ErrorName();
  }
}

/// Binary content, which XML must not have.
int line_of_zero_byte(const std::string& text) {
  const std::size_t zero = text.find('\0');
  return zero == std::string::npos
             ? 0
             : 1 + static_cast<int>(std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(zero), '\n'));
}

}  // namespace

std::optional<Element> read_xml_file(const std::string& path, Problems& problems) {
  const auto text = read_whole_file(path, "", kLargestFile);
  if (text.ok()) return read_xml_text(text.value(), path, problems);
  problems.push_back({path, 0, text.error().message, false});
  return std::nullopt;
}

std::optional<Element> read_xml_text(const std::string& text, const std::string& name, Problems& problems) {
  Converter converter(name, problems);
  if (const int line = line_of_zero_byte(text); line > 0) {
    converter.problem(line, "there is a zero byte: this is not an XML file");
    return std::nullopt;
  }
  tinyxml2::XMLDocument document;
  if (document.Parse(text.data(), text.size()) != tinyxml2::XML_SUCCESS) {
    const tinyxml2::XMLError error = document.ErrorID();
    const bool order = error == tinyxml2::XML_ERROR_MISMATCHED_ELEMENT || error == tinyxml2::XML_ERROR_PARSING;
    if (const auto [open, instead] = order ? Tags(text).unclosed() : std::pair<Open, std::string>(); open.line > 0)
      converter.problem(open.line, "not well-formed XML: <" + open.name + "> is never closed: " + instead);
    else
      converter.problem(std::max(document.ErrorLineNum(), 1), why_not_xml(document));
    return std::nullopt;
  }
  const tinyxml2::XMLElement* root = document.RootElement();
  if (root == nullptr) {
    converter.problem(1, "there is no element in the file");
    return std::nullopt;
  }
  for (const auto* next = root->NextSiblingElement(); next != nullptr; next = next->NextSiblingElement()) {
    converter.problem(next->GetLineNum(),
                      std::string("a second root element <") + next->Name() + ">; everything belongs in one");
  }
  return converter.convert(*root, false, root->Name() == kArgosRoot);
}

std::string to_xml(const Element& element) {
  tinyxml2::XMLPrinter printer;
  print(element, printer);
  return printer.CStr();
}

}  // namespace tandem::hal
