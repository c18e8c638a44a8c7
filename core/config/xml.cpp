#include "core/config/xml.hpp"

#include <tinyxml2.h>

#include <filesystem>
#include <fstream>
#include <sstream>

namespace tandem::core {
namespace {

constexpr std::uintmax_t kLargestFile = 64U << 20U;

Element convert(const tinyxml2::XMLElement& from, const std::string& file) {
  Element element;
  element.name = from.Name();
  element.file = file;
  element.line = from.GetLineNum();
  for (const auto* a = from.FirstAttribute(); a != nullptr; a = a->Next()) {
    element.attributes.push_back({a->Name(), a->Value(), a->GetLineNum()});
  }
  for (const auto* c = from.FirstChildElement(); c != nullptr; c = c->NextSiblingElement()) {
    element.children.push_back(convert(*c, file));
  }
  return element;
}

void print(const Element& element, tinyxml2::XMLPrinter& printer) {
  printer.OpenElement(element.name.c_str());
  for (const Element::Attribute& a : element.attributes) printer.PushAttribute(a.name.c_str(), a.value.c_str());
  for (const Element& child : element.children) print(child, printer);
  printer.CloseElement();
}

}  // namespace

std::optional<Element> read_xml_file(const std::string& path, Problems& problems) {
  namespace fs = std::filesystem;
  std::error_code error;
  const auto refuse = [&](std::string why) {
    problems.push_back({path, 0, std::move(why), false});
    return std::nullopt;
  };
  if (!fs::exists(path, error)) return refuse("there is no such file");
  if (fs::is_directory(path, error)) return refuse("this is a folder; give the path of an experiment file (.xml)");
  if (!fs::is_regular_file(path, error)) return refuse("this is not a regular file");
  if (fs::file_size(path, error) > kLargestFile) return refuse("the file is larger than 64 MiB; that is no experiment");
  std::ifstream in(path, std::ios::binary);
  std::ostringstream text;
  if (!in || !(text << in.rdbuf())) {
    if (fs::file_size(path, error) == 0) return refuse("the file is empty");
    return refuse("the file cannot be read; check its permissions");
  }
  return read_xml_text(text.str(), path, problems);
}

std::optional<Element> read_xml_text(const std::string& text, const std::string& name, Problems& problems) {
  tinyxml2::XMLDocument document;
  if (document.Parse(text.data(), text.size()) != tinyxml2::XML_SUCCESS) {
    const bool empty = document.ErrorID() == tinyxml2::XML_ERROR_EMPTY_DOCUMENT;
    const std::string why = empty ? "the file is empty" : std::string("not well-formed XML: ") + document.ErrorName();
    problems.push_back({name, document.ErrorLineNum(), why, false});
    return std::nullopt;
  }
  const tinyxml2::XMLElement* root = document.RootElement();
  if (root == nullptr) {
    problems.push_back({name, 1, "there is no element in the file", false});
    return std::nullopt;
  }
  for (const auto* next = root->NextSiblingElement(); next != nullptr; next = next->NextSiblingElement()) {
    problems.push_back({name, next->GetLineNum(), std::string("a second root element <") + next->Name() + ">; everything belongs in one", false});
  }
  return convert(*root, name);
}

std::string to_xml(const Element& element) {
  tinyxml2::XMLPrinter printer;
  print(element, printer);
  return printer.CStr();
}

}  // namespace tandem::core
