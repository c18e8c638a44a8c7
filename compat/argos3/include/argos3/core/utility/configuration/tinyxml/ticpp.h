// Elements of files, by the names of TinyXML++. A copy of an element is the same element.
#ifndef TANDEM_ARGOS3_TICPP_H
#define TANDEM_ARGOS3_TICPP_H
#include <cstddef>
#include <exception>
#include <iostream>
#include <memory>
#include <sstream>
#include <string>
#include <vector>

namespace ticpp {

class Exception : public std::exception {
 public:
  explicit Exception(const std::string& details);
  ~Exception() noexcept override;
  const char* what() const noexcept override;
  std::string m_details;
};

class Element;
class Document;
class Node;

namespace detail {

/// Of an element or a document, which all of its copies share.
struct Data;

template <typename T>
void from_text(const std::string& text, T* out) {
  std::istringstream in(text);
  in >> *out;
  if (in.fail()) throw Exception("'" + text + "' cannot be converted to what is asked for");
}
inline void from_text(const std::string& text, std::string* out) {
  *out = text;
}
template <typename T>
std::string to_text(const T& value) {
  std::ostringstream out;
  out.precision(17);  // real numbers come back as they were
  out << value;
  return out.str();
}

}  // namespace detail

class Attribute {
 public:
  Attribute(const std::string& name, const std::string& value) : name_(name), value_(value) {}
  std::string Name() const { return name_; }
  std::string Value() const { return value_; }
  template <typename T>
  void GetName(T* name) const {
    detail::from_text(name_, name);
  }
  template <typename T>
  void GetValue(T* value) const {
    detail::from_text(value_, value);
  }
  template <typename T>
  void SetValue(const T& value) {
    value_ = detail::to_text(value);
  }

 private:
  friend struct detail::Data;
  std::string name_, value_;
  const detail::Data* owner_ = nullptr;
};

/// An element or a document. Functions that give a node back throw Exception where there is none, unless `must` is
/// false.
class Node {
 public:
  Node(const Node&);
  Node& operator=(const Node& other);
  virtual ~Node();

  /// The element's name.
  std::string Value() const;
  template <typename T>
  void GetValue(T* value) const {
    detail::from_text(Value(), value);
  }
  void SetValue(const std::string& name);
  /// Its line in the file; 0 when it is of none.
  int Row() const;
  void Clear();

  Node* Parent(bool must = true) const;
  Node* FirstChild(bool must = true) const;
  Node* FirstChild(const std::string& name, bool must = true) const;
  Node* FirstChild(const char* name, bool must = true) const { return FirstChild(std::string(name), must); }
  Node* LastChild(bool must = true) const;
  Node* NextSibling(bool must = true) const;
  Node* NextSibling(const std::string& name, bool must = true) const;
  Node* NextSibling(const char* name, bool must = true) const { return NextSibling(std::string(name), must); }
  Node* PreviousSibling(bool must = true) const;
  Element* FirstChildElement(bool must = true) const;
  Element* FirstChildElement(const std::string& name, bool must = true) const;
  Element* FirstChildElement(const char* name, bool must = true) const { return FirstChildElement(std::string(name), must); }
  Element* NextSiblingElement(bool must = true) const;
  Element* NextSiblingElement(const std::string& name, bool must = true) const;
  Element* NextSiblingElement(const char* name, bool must = true) const { return NextSiblingElement(std::string(name), must); }
  bool NoChildren() const;
  Node* InsertEndChild(const Node& child);
  Node* LinkEndChild(Node* child);
  void RemoveChild(Node* child);
  Element* ToElement();

  bool operator==(const Node& other) const { return data_ == other.data_; }
  bool operator!=(const Node& other) const { return data_ != other.data_; }
  friend std::ostream& operator<<(std::ostream& out, const Node& node);

 protected:
  explicit Node(const std::string& name);
  std::shared_ptr<detail::Data> data_;
  friend struct detail::Data;
};

std::ostream& operator<<(std::ostream& out, const Node& node);

class Element : public Node {
 public:
  Element();
  Element(const std::string& name);
  Element(const char* name);
  template <typename T>
  Element(const std::string& name, const T& text) : Element(name) {
    SetText(text);
  }
  ~Element() override;

  bool HasAttribute(const std::string& name) const;
  /// @throws Exception when it is not there and `must`, or no such value
  template <typename T>
  void GetAttribute(const std::string& name, T* value, bool must = true) const {
    const Attribute* const there = Find(name, must);
    if (there != nullptr) Convert(*there, value);
  }
  template <typename T>
  T GetAttribute(const std::string& name, bool must = true) const {
    T value = T();
    GetAttribute(name, &value, must);
    return value;
  }
  /// Empty when it is not there.
  std::string GetAttribute(const std::string& name) const;
  template <typename T, typename D>
  void GetAttributeOrDefault(const std::string& name, T* value, const D& otherwise) const {
    const Attribute* const there = Find(name, false);
    if (there != nullptr)
      Convert(*there, value);
    else
      *value = static_cast<T>(otherwise);
  }
  std::string GetAttributeOrDefault(const std::string& name, const std::string& otherwise) const;
  template <typename T>
  void SetAttribute(const std::string& name, const T& value) {
    Store(name, detail::to_text(value));
  }
  void RemoveAttribute(const std::string& name);
  Attribute* FirstAttribute(bool must = true) const;

  std::string GetText(bool must = true) const;
  template <typename T>
  void GetText(T* value, bool must = true) const {
    if (must || HasText()) detail::from_text(GetText(must), value);
  }
  std::string GetTextOrDefault(const std::string& otherwise) const { return HasText() ? GetText() : otherwise; }
  template <typename T, typename D>
  void GetTextOrDefault(T* value, const D& otherwise) const {
    if (HasText())
      detail::from_text(GetText(), value);
    else
      *value = static_cast<T>(otherwise);
  }
  template <typename T>
  void SetText(const T& value) {
    StoreText(detail::to_text(value));
  }

 private:
  bool HasText() const;
  const Attribute* Find(const std::string& name, bool must) const;
  void Store(const std::string& name, const std::string& value);
  void StoreText(const std::string& text);
  std::string Where(const std::string& name) const;
  template <typename T>
  void Convert(const Attribute& attribute, T* value) const {
    try {
      attribute.GetValue(value);
    } catch (const std::exception& e) {
      throw Exception(Where(attribute.Name()) + ": " + e.what());
    }
  }
};

class Document : public Node {
 public:
  Document();
  Document(const std::string& file);
  ~Document() override;
  /// @throws Exception with all problems
  void LoadFile();
  void LoadFile(const std::string& file);
  void SaveFile() const;
  void SaveFile(const std::string& file) const;
  void Parse(const std::string& xml);

 private:
  std::string file_;
};

namespace detail {
// Of that name, unless it is empty; null when there is none.
void first(const Node* parent, const std::string& name, Element** out);
void first(const Node* parent, const std::string& name, Node** out);
void first(const Element* parent, const std::string& name, Attribute** out);
void advance(const std::string& name, Element** at);
void advance(const std::string& name, Node** at);
void advance(const std::string& name, Attribute** at);
}  // namespace detail

/// `for (it = it.begin(&parent); it != it.end(); ++it)`: over children, or over attributes.
template <class T = Node>
class Iterator {
 public:
  Iterator() {}
  Iterator(const std::string& name) : name_(name) {}
  Iterator(const char* name) : name_(name) {}
  Iterator(T* node) : at_(node) {}

  template <class Parent>
  T* begin(const Parent* parent) const {
    T* first = nullptr;
    detail::first(parent, name_, &first);
    return first;
  }
  T* end() const { return nullptr; }
  T* Get() const { return at_; }
  Iterator& operator=(T* node) {
    at_ = node;
    return *this;
  }
  Iterator& operator++() {
    detail::advance(name_, &at_);
    return *this;
  }
  Iterator operator++(int) {
    Iterator before(*this);
    ++*this;
    return before;
  }
  T& operator*() const { return *at_; }
  T* operator->() const { return at_; }
  bool operator==(const T* node) const { return at_ == node; }
  bool operator!=(const T* node) const { return at_ != node; }
  bool operator==(const Iterator& other) const { return at_ == other.at_; }
  bool operator!=(const Iterator& other) const { return at_ != other.at_; }

 private:
  T* at_ = nullptr;
  std::string name_;
};

}  // namespace ticpp

#endif
