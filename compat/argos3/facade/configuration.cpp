// Elements of files as the facade has them, on hal::Element.
#include "compat/argos3/facade/configuration.hpp"

#include <algorithm>
#include <fstream>

#include "hal/xml/xml.hpp"

namespace ticpp {

struct detail::Data {
  std::string name, text;
  int line = 0;
  std::vector<std::unique_ptr<Attribute>> attributes;
  std::vector<std::unique_ptr<Element>> children;
  Data* parent = nullptr;
  Node* node = nullptr;  // in its parent's list, or a root's first; null when that is gone and copies live on

  Data() = default;
  Data(const Data&) = delete;
  Data& operator=(const Data&) = delete;
  ~Data() {  // copies of children may live on
    for (const auto& child : children) of(*child).parent = nullptr;
  }
  static Data& of(const Node& node) { return *node.data_; }
  static void leave(const Node& node) {
    if (node.data_->node == &node) node.data_->node = nullptr;
  }

  Element& add(std::unique_ptr<Element> child) {
    Data& data = of(*child);
    data.parent = this;
    data.node = child.get();
    return *children.emplace_back(std::move(child));
  }
  Attribute& add(const std::string& attribute, const std::string& value) {
    Attribute& added = *attributes.emplace_back(std::make_unique<Attribute>(attribute, value));
    added.owner_ = this;
    return added;
  }
  static const Data& owner(const Attribute& attribute) { return *attribute.owner_; }
  static bool fits(const Element& element, const std::string& name) { return name.empty() || of(element).name == name; }
  static bool fits(const Attribute& attribute, const std::string& name) {
    return name.empty() || attribute.Name() == name;
  }
  /// From number `from` on; null: none.
  template <class T>
  static T* find(const std::vector<std::unique_ptr<T>>& all, const std::string& name, std::size_t from) {
    for (std::size_t i = from; i < all.size(); ++i) {
      if (fits(*all[i], name)) return all[i].get();
    }
    return nullptr;
  }
  template <class T>
  static std::size_t after(const std::vector<std::unique_ptr<T>>& all, const void* one) {
    std::size_t i = 0;
    while (i < all.size() && all[i].get() != one) ++i;
    return i + 1;
  }
  Element* next(const std::string& wanted) const {
    return parent == nullptr ? nullptr : find(parent->children, wanted, after(parent->children, node));
  }
  /// `lines`: those of `from` are lines of a file.
  void fill(const tandem::hal::Element& from, bool lines) {
    name = from.name;
    line = lines ? from.line : 0;
    text = from.text;
    for (const auto& a : from.attributes) add(a.name, a.value);
    for (const auto& child : from.children) of(add(std::make_unique<Element>(child.name))).fill(child, lines);
  }
  tandem::hal::Element plain() const {
    tandem::hal::Element out;
    out.name = name;
    out.line = line;
    out.text = text;
    for (const auto& a : attributes) out.attributes.push_back({a->Name(), a->Value(), line});
    for (const auto& child : children) out.children.push_back(of(*child).plain());
    return out;
  }
};

namespace {

using detail::Data;

template <class T>
T* checked(T* found, bool must, const Node& node, const char* what) {
  if (found == nullptr && must) throw Exception("<" + node.Value() + "> has no " + what);
  return found;
}

}  // namespace

namespace detail {

void first(const Node* parent, const std::string& name, Element** out) {
  *out = Data::find(Data::of(*parent).children, name, 0);
}
void first(const Node* parent, const std::string& name, Node** out) {
  *out = Data::find(Data::of(*parent).children, name, 0);
}
void first(const Element* parent, const std::string& name, Attribute** out) {
  *out = Data::find(Data::of(*parent).attributes, name, 0);
}
void advance(const std::string& name, Element** at) {
  *at = Data::of(**at).next(name);
}
void advance(const std::string& name, Node** at) {
  *at = Data::of(**at).next(name);
}
void advance(const std::string& name, Attribute** at) {
  const Data& owner = Data::owner(**at);
  *at = Data::find(owner.attributes, name, Data::after(owner.attributes, *at));
}

}  // namespace detail

Exception::Exception(const std::string& details) : m_details(details) {}
Exception::~Exception() noexcept = default;
const char* Exception::what() const noexcept {
  return m_details.c_str();
}

Node::Node(const std::string& name) : data_(std::make_shared<Data>()) {
  data_->name = name;
  data_->node = this;
}
Node::Node(const Node&) = default;
Node& Node::operator=(const Node& other) {
  Data::leave(*this);
  data_ = other.data_;
  return *this;
}
Node::~Node() {
  Data::leave(*this);
}

std::string Node::Value() const {
  return data_->name;
}
void Node::SetValue(const std::string& name) {
  data_->name = name;
}
int Node::Row() const {
  return data_->line;
}
void Node::Clear() {
  for (const auto& child : data_->children) Data::of(*child).parent = nullptr;
  data_->children.clear();
}

Node* Node::Parent(bool must) const {
  return checked(data_->parent == nullptr ? nullptr : data_->parent->node, must, *this, "parent");
}
Node* Node::FirstChild(bool must) const {
  return FirstChildElement(std::string(), must);
}
Node* Node::FirstChild(const std::string& name, bool must) const {
  return FirstChildElement(name, must);
}
Node* Node::LastChild(bool must) const {
  return checked(data_->children.empty() ? nullptr : data_->children.back().get(), must, *this, "child");
}
Node* Node::NextSibling(bool must) const {
  return NextSiblingElement(std::string(), must);
}
Node* Node::NextSibling(const std::string& name, bool must) const {
  return NextSiblingElement(name, must);
}
Node* Node::PreviousSibling(bool must) const {
  Node* found = nullptr;
  if (data_->parent != nullptr) {
    const auto& all = data_->parent->children;
    const std::size_t next = Data::after(all, data_->node);
    if (next >= 2 && next <= all.size()) found = all[next - 2].get();
  }
  return checked(found, must, *this, "sibling before it");
}
Element* Node::FirstChildElement(bool must) const {
  return FirstChildElement(std::string(), must);
}
Element* Node::FirstChildElement(const std::string& name, bool must) const {
  return checked(Data::find(data_->children, name, 0), must, *this, ("child <" + name + ">").c_str());
}
Element* Node::NextSiblingElement(bool must) const {
  return NextSiblingElement(std::string(), must);
}
Element* Node::NextSiblingElement(const std::string& name, bool must) const {
  return checked(data_->next(name), must, *this, "sibling after it");
}
bool Node::NoChildren() const {
  return data_->children.empty();
}
Node* Node::InsertEndChild(const Node& child) {
  Element& added = data_->add(std::make_unique<Element>(child.Value()));
  Data& data = Data::of(added);
  data.text = child.data_->text;
  data.line = child.data_->line;
  for (const auto& a : child.data_->attributes) data.add(a->Name(), a->Value());
  for (const auto& inner : child.data_->children) added.InsertEndChild(*inner);
  return &added;
}
Node* Node::LinkEndChild(Node* child) {
  Element* const element = dynamic_cast<Element*>(child);
  if (element == nullptr) throw Exception("<" + Value() + "> takes elements as children, not documents");
  return &data_->add(std::unique_ptr<Element>(element));
}
void Node::RemoveChild(Node* child) {
  std::erase_if(data_->children, [&](const auto& one) {
    if (one.get() != child) return false;
    Data::of(*one).parent = nullptr;
    return true;
  });
}
Element* Node::ToElement() {
  return checked(dynamic_cast<Element*>(this), true, *this, "form as an element: it is a document");
}

std::ostream& operator<<(std::ostream& out, const Node& node) {
  return out << tandem::hal::to_xml(Data::of(node).plain());
}

Element::Element() : Element(std::string()) {}
Element::Element(const std::string& name) : Node(name) {}
Element::Element(const char* name) : Node(name) {}
Element::~Element() = default;

bool Element::HasAttribute(const std::string& name) const {
  return Find(name, false) != nullptr;
}
std::string Element::GetAttribute(const std::string& name) const {
  const Attribute* const there = Find(name, false);
  return there == nullptr ? std::string() : there->Value();
}
std::string Element::GetAttributeOrDefault(const std::string& name, const std::string& otherwise) const {
  const Attribute* const there = Find(name, false);
  return there == nullptr ? otherwise : there->Value();
}
void Element::RemoveAttribute(const std::string& name) {
  std::erase_if(data_->attributes, [&](const auto& one) { return one->Name() == name; });
}
Attribute* Element::FirstAttribute(bool must) const {
  return checked(Data::find(data_->attributes, std::string(), 0), must, *this, "attribute");
}
std::string Element::GetText(bool must) const {
  if (must && !HasText()) throw Exception("<" + Value() + "> holds no text");
  return data_->text;
}
bool Element::HasText() const {
  return !data_->text.empty();
}
const Attribute* Element::Find(const std::string& name, bool must) const {
  for (const auto& one : data_->attributes) {
    if (one->Name() == name) return one.get();
  }
  if (must) throw Exception(Where(name) + " is not there");
  return nullptr;
}
void Element::Store(const std::string& name, const std::string& value) {
  for (const auto& one : data_->attributes) {
    if (one->Name() == name) return one->SetValue(value);
  }
  data_->add(name, value);
}
void Element::StoreText(const std::string& text) {
  data_->text = text;
}
std::string Element::Where(const std::string& name) const {
  return "the attribute '" + name + "' of <" + Value() + ">" +
         (data_->line > 0 ? ", line " + std::to_string(data_->line) + "," : "");
}

Document::Document() : Node(std::string()) {}
Document::Document(const std::string& file) : Node(std::string()), file_(file) {}
Document::~Document() = default;

namespace {
/// Fills the document, or says why not.
void fill(Data& document, const std::optional<tandem::hal::Element>& root, const tandem::hal::Problems& problems) {
  if (!root) {
    std::string all;
    for (const tandem::hal::Problem& problem : problems) all += (all.empty() ? "" : "\n") + to_text(problem);
    throw Exception(all);
  }
  Data::of(document.add(std::make_unique<Element>(root->name))).fill(*root, true);
}
}  // namespace

void Document::LoadFile() {
  LoadFile(file_);
}
void Document::LoadFile(const std::string& file) {
  file_ = file;
  Clear();
  tandem::hal::Problems problems;
  fill(*data_, tandem::hal::read_xml_file(file, problems), problems);
}
void Document::Parse(const std::string& xml) {
  Clear();
  tandem::hal::Problems problems;
  fill(*data_, tandem::hal::read_xml_text(xml, "the text", problems), problems);
}
void Document::SaveFile() const {
  SaveFile(file_);
}
void Document::SaveFile(const std::string& file) const {
  std::ofstream out(file);
  for (const auto& child : data_->children) out << *child;
  if (!out.flush()) throw Exception("'" + file + "' cannot be written");
}

}  // namespace ticpp

namespace tandem::compat::argos3 {

std::unique_ptr<ticpp::Element> to_node(const hal::Element& element, bool lines) {
  auto node = std::make_unique<ticpp::Element>(element.name);
  ticpp::detail::Data::of(*node).fill(element, lines);
  return node;
}

}  // namespace tandem::compat::argos3
