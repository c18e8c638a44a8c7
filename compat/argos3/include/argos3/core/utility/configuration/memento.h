// Objects that are written into bytes and read from there.
#ifndef TANDEM_ARGOS3_MEMENTO_H
#define TANDEM_ARGOS3_MEMENTO_H
#include <argos3/core/utility/datatypes/byte_array.h>

namespace argos {

class CMemento {
 public:
  virtual ~CMemento() {}
  virtual void SaveState(CByteArray& buffer) = 0;
  virtual void LoadState(CByteArray& buffer) = 0;
};

}  // namespace argos

#endif
