// The curve of solutions of P(y, p) = y over a parameter p: points on it by Newton's method, and its tangent there.
// MODEL.md (S76).
#pragma once

#include <Eigen/Core>
#include <optional>

#include "sim/orbit/continuation.hpp"
#include "sim/orbit/section_map.hpp"

namespace beamcam::sim {

// A point of the curve: z is the state of the orbit and the parameter, in shares of its range; `tangent` is that of the
// curve.
struct ArcPoint {
    Eigen::VectorXd z, tangent;
    Eigen::MatrixXd derivative;  // of the section map
    PeriodicOrbit orbit;
};

class BranchArc {
  public:
    // The orbits have the section and the phase of `like`. `progress` receives the parameter.
    BranchArc(const Family& family, const ContinuationRequest& request, const PeriodicOrbit& like, int turns,
              const SectionScale& scale, const Progress& progress)
        : family_(family), request_(request), like_(like), turns_(turns), scale_(scale), progress_(progress) {}

    double parameter(const Eigen::VectorXd& z) const { return parameter(z[z.size() - 1]); }
    double share(double parameter) const { return (parameter - request_.from) / (request_.to - request_.from); }
    // z of the point; z of `like` at this parameter.
    Eigen::VectorXd place(const BranchPoint& point) const;
    Eigen::VectorXd place(double parameter) const { return place(BranchPoint{parameter, like_}); }
    double section() const { return like_.section; }
    BranchPoint branch_point(const ArcPoint& point) const { return {parameter(point.z), point.orbit}; }
    Eigen::MatrixXd derivative_at(const BranchPoint& point) const;

    // The same curve with its section in the middle of this point's longest flight.
    BranchArc recentred(const BranchPoint& point) const;
    // The curve of the orbits with that many turns, with the same section and coordinates.
    BranchArc of_turns(int turns) const { return {family_, request_, like_, turns, scale_, progress_}; }

    // The solution on the plane through z perpendicular to the tangent; nothing if Newton's method does not converge.
    std::optional<ArcPoint> correct(Eigen::VectorXd z, const Eigen::VectorXd& tangent) const;

  private:
    double parameter(double share) const;
    SectionMap map(double share) const;
    Progress poll(double parameter) const;
    std::optional<SectionMap::Value> image(const Eigen::VectorXd& z) const;
    Eigen::VectorXd slope(const Eigen::VectorXd& z, const Eigen::VectorXd& tangent,
                          const SectionMap::Value& here) const;

    Family family_;
    ContinuationRequest request_;
    PeriodicOrbit like_;
    int turns_;
    SectionScale scale_;
    Progress progress_;
};

}  // namespace beamcam::sim
