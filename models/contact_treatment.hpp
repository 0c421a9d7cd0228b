// What becomes of contact forces.
#pragma once

namespace shapeid {

enum class ContactTreatment {
  project,   ///< equation (9): contact forces unknown and eliminated
  measured,  ///< equation (4): contact forces measured and moved to the right-hand side
  ignore     ///< no contact, or a fixed base
};

}  // namespace shapeid
