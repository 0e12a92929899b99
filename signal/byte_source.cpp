#include "signal/byte_source.h"

namespace fude {

Result<void> ByteSource::write(const Transfer&) {
  return failure(Fault::unsupported, "this device takes no messages");
}

}  // namespace fude
