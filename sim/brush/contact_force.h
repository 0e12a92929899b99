// What the tuft does to the hand: the derivative of the minimised energy by the pose of the handle (envelope
// theorem: only what the pose moves counts, not how the tuft gives way), and how it changes when the handle
// moves on within the step.
#pragma once

#include "signal/contact_model.h"
#include "sim/brush/tuft_energy.h"

namespace fude {

// Force and torque on the hand at the origin of Handle, in axes of Paper. x and the multipliers are the
// solution of the frozen step (sqp.h). Weight is not in it: the energies have none.
Wrench contact_wrench(const Tuft& tuft, const FrozenStep& frozen, const Variables& x,
                      const Multipliers& multipliers);

// The same with its stiffness, the tuft giving way as it is solved: touching state, reactions and anchors of
// the frozen step, and its internal friction over that step. What rests on the paper goes on resting, what is
// free stays free. Some 60 evaluations of the program. `valid_until` is the caller's to set.
ContactModel contact_model(const Tuft& tuft, const FrozenStep& frozen, const Variables& x,
                           const Multipliers& multipliers);

}  // namespace fude
