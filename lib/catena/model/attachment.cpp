#include "catena/model/attachment.hpp"

#include "catena/base/design_scalar.hpp"
#include "catena/elements/all.hpp"

namespace catena {

template <class S>
BasicAttachment<S> attachment_of(const BasicModel<S>& model, int element) {
  BasicAttachment<S> attachment;
  with_entry(model, element, [&](const auto& entry) { attachment = attachment_of(entry); });
  return attachment;
}

template BasicAttachment<double> attachment_of(const BasicModel<double>&, int);
template BasicAttachment<DesignScalar> attachment_of(const BasicModel<DesignScalar>&, int);

}  // namespace catena
