// Classes by their labels.
#ifndef TANDEM_ARGOS3_FACTORY_H
#define TANDEM_ARGOS3_FACTORY_H
#include <cstdlib>
#include <iostream>
#include <map>
#include <string>

#include <argos3/core/utility/configuration/argos_exception.h>

namespace argos {

namespace tandem_detail {

/// What one macro REGISTER_… says of a class. It lies in the library that has the class.
struct SRegistration {
  const char* Kind;      ///< "controller", "loop functions", …
  const char* Label;     ///< as files name it
  const char* ClassName;
  void* (*Create)();     ///< gives a pointer to the base class of this kind
  SRegistration* Next;
};

/// From when its library is loaded until it is closed.
void Register(SRegistration& registration);
void Unregister(SRegistration& registration);
/// Brings the note that makes a plug-in of a library: it lies in libtandem_argos3_plugin.a, which goes with every library of
/// ARGoS' names. An undefined one says that the library was not linked with argos3core_simulator.
void LinkPlugin();

}  // namespace tandem_detail
}  // namespace argos

#define TANDEM_ARGOS3_NAME_(a, b) a##b
#define TANDEM_ARGOS3_NAME(a, b) TANDEM_ARGOS3_NAME_(a, b)

/// Registers a class as one of `KIND`, when its library is loaded.
#define TANDEM_ARGOS3_REGISTER(KIND, BASE, CLASSNAME, LABEL, NUMBER)                                              \
  namespace {                                                                                                     \
  void* TANDEM_ARGOS3_NAME(TandemCreate, NUMBER)() {                                                              \
    return static_cast<BASE*>(new CLASSNAME);                                                                     \
  }                                                                                                               \
  struct TANDEM_ARGOS3_NAME(STandemRegistration, NUMBER) {                                                        \
    ::argos::tandem_detail::SRegistration Registration;                                                           \
    TANDEM_ARGOS3_NAME(STandemRegistration, NUMBER)                                                               \
    () : Registration{KIND, LABEL, #CLASSNAME, &TANDEM_ARGOS3_NAME(TandemCreate, NUMBER), nullptr} {              \
      ::argos::tandem_detail::Register(Registration);                                                             \
      ::argos::tandem_detail::LinkPlugin();                                                                       \
    }                                                                                                             \
    TANDEM_ARGOS3_NAME(~STandemRegistration, NUMBER)() { ::argos::tandem_detail::Unregister(Registration); }      \
  } TANDEM_ARGOS3_NAME(g_tandemRegistration, NUMBER);                                                             \
  }

#endif
