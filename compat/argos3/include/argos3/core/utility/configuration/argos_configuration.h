// Elements of files: nodes, their attributes and texts, as values of any type that `>>` reads.
#ifndef TANDEM_ARGOS3_CONFIGURATION_H
#define TANDEM_ARGOS3_CONFIGURATION_H
#include <string>

#include <argos3/core/utility/configuration/argos_exception.h>
#include <argos3/core/utility/configuration/tinyxml/ticpp.h>
#include <argos3/core/utility/datatypes/datatypes.h>
#include <argos3/core/utility/string_utilities.h>

namespace argos {

typedef ticpp::Element TConfigurationNode;
typedef ticpp::Iterator<ticpp::Element> TConfigurationNodeIterator;
typedef ticpp::Iterator<ticpp::Attribute> TConfigurationAttributeIterator;

namespace tandem_detail {

inline bool ToBool(const std::string& text) {
  if (text != "true" && text != "false")
    THROW_ARGOSEXCEPTION("'" << text << "' is no boolean: it is 'true' or 'false'")
  return text == "true";
}

/// How a value of type T is read: as `Read`, then converted.
template <typename T>
struct TAttribute {
  static void Get(const TConfigurationNode& node, const std::string& name, T& value) { node.GetAttribute(name, &value); }
};
template <>
struct TAttribute<bool> {
  static void Get(const TConfigurationNode& node, const std::string& name, bool& value) {
    std::string text;
    node.GetAttribute(name, &text);
    value = ToBool(text);
  }
};
template <typename T>
struct TByteAttribute {
  static void Get(const TConfigurationNode& node, const std::string& name, T& value) {
    SInt32 number = 0;
    node.GetAttribute(name, &number);
    value = ToByte<T>(number);
  }
};
template <>
struct TAttribute<UInt8> : TByteAttribute<UInt8> {};
template <>
struct TAttribute<SInt8> : TByteAttribute<SInt8> {};

}  // namespace tandem_detail

inline bool NodeExists(TConfigurationNode& node, const std::string& tag) {
  return node.FirstChildElement(tag, false) != nullptr;
}

/// The first child of that name. @throws CARGoSException when there is none
inline TConfigurationNode& GetNode(TConfigurationNode& node, const std::string& tag) {
  TConfigurationNode* const child = node.FirstChildElement(tag, false);
  if (child == nullptr) THROW_ARGOSEXCEPTION("<" << node.Value() << "> has no child <" << tag << ">")
  return *child;
}

/// Adds a copy.
inline void AddChildNode(TConfigurationNode& parent, TConfigurationNode& child) {
  parent.InsertEndChild(child);
}

template <typename T>
void GetNodeText(TConfigurationNode& node, T& value) {
  try {
    node.GetText(&value);
  } catch (std::exception& e) {
    THROW_ARGOSEXCEPTION_NESTED("the text of <" << node.Value() << "> cannot be read", e)
  }
}
template <typename T, typename D>
void GetNodeTextOrDefault(TConfigurationNode& node, T& value, const D& otherwise) {
  try {
    node.GetTextOrDefault(&value, otherwise);
  } catch (std::exception& e) {
    THROW_ARGOSEXCEPTION_NESTED("the text of <" << node.Value() << "> cannot be read", e)
  }
}

inline bool NodeAttributeExists(TConfigurationNode& node, const std::string& attribute) {
  return node.HasAttribute(attribute);
}

/// @throws CARGoSException when it is not there, or no such value
template <typename T>
void GetNodeAttribute(TConfigurationNode& node, const std::string& attribute, T& value) {
  try {
    tandem_detail::TAttribute<T>::Get(node, attribute, value);
  } catch (std::exception& e) {
    THROW_ARGOSEXCEPTION_NESTED("the attribute '" << attribute << "' of <" << node.Value() << "> cannot be read", e)
  }
}
/// @throws CARGoSException when it is there, and no such value
template <typename T, typename D>
void GetNodeAttributeOrDefault(TConfigurationNode& node, const std::string& attribute, T& value, const D& otherwise) {
  if (node.HasAttribute(attribute))
    GetNodeAttribute(node, attribute, value);
  else
    value = static_cast<T>(otherwise);
}

template <typename T>
void SetNodeAttribute(TConfigurationNode& node, const std::string& attribute, const T& value) {
  node.SetAttribute(attribute, value);
}
inline void SetNodeAttribute(TConfigurationNode& node, const std::string& attribute, const bool value) {
  node.SetAttribute(attribute, value ? "true" : "false");
}
inline void SetNodeAttribute(TConfigurationNode& node, const std::string& attribute, const SInt8 value) {
  node.SetAttribute(attribute, static_cast<SInt32>(value));
}
inline void SetNodeAttribute(TConfigurationNode& node, const std::string& attribute, const UInt8 value) {
  node.SetAttribute(attribute, static_cast<UInt32>(value));
}

}  // namespace argos

#endif
