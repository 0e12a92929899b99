// How likely a height is where a touch was felt between two samples of a path that is known with some noise.
#pragma once

namespace fude {

// A touch was felt at any moment of a span that the path crosses at an even rate, so its height lies anywhere
// within `half` of the middle's; the path's own noise of `sd` comes on top: an even density with blurred
// ends. It tells more than a Gaussian of the same variance where the path is known better than to `half`.
struct FeltTouch {
  double half = 0;
  double sd = 0;  // over 0

  double variance() const { return sd * sd + half * half / 3; }
  double log_density(double off) const;
  double score(double off) const;  // less the derivative of log_density
  double information() const;      // the mean of score squared
};

}  // namespace fude
