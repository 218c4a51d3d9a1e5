#include "sim/observe/beam_loads.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace beamcam::sim {

Vec2 point_acceleration(const Model& model, const double* acceleration, double x) {
    double jx[kMaxSize], jy[kMaxSize], jchi[kMaxSize];
    model.jacobian(x, jx, jy, jchi);
    Vec2 out = model.convective(x);
    for (int i = 0; i < model.size(); ++i) out = out + acceleration[i] * Vec2{jx[i], jy[i]};
    return out;
}

// As many nodes as resolve the square of the highest shape.
BeamLoads::BeamLoads(const Problem& problem, Model& model)
    : rule_(gauss_legendre(2 * (problem.beam.model == ModelKind::rigid ? 0 : problem.beam.modes) + 24,
                           problem.beam.length)),
      integral_(rule_, problem.beam.length),
      beyond_(rule_.w.transpose().replicate(rule_.x.size(), 1) - integral_.matrix(rule_)),
      length_(problem.beam.length),
      line_density_(problem.beam.line_density()),
      gravity_(problem.gravity),
      offset_(contact_offset(problem)) {
    model.keep(rule_.x);
    for (Eigen::VectorXd* v : {&force_x_, &force_y_, &turn_, &x_, &y_, &weights_}) v->resize(rule_.x.size());
}

void BeamLoads::set(const Model& model, const double* acceleration, const ContactState* contact) {
    model_ = &model;
    contact_x_.reset();
    BeamPoint p;
    if (contact) {
        model.point(contact->x, p);
        const Vec2 face = p.r - offset_ * contact->normal;
        contact_x_ = contact->x;
        contact_force_ = contact->force * contact->normal + contact->friction * contact->tangent;
        contact_turn_ = cross(face, contact_force_);
    }
    for (Eigen::Index k = 0; k < rule_.x.size(); ++k) {
        model.point(rule_.x[k], p);
        const Vec2 force = -line_density_ * (point_acceleration(model, acceleration, rule_.x[k]) + Vec2{0, gravity_});
        x_[k] = p.r.x;
        y_[k] = p.r.y;
        force_x_[k] = force.x;
        force_y_[k] = force.y;
        turn_[k] = cross(p.r, force);
    }
}

// M(x) = ∫ₓᴸ (r(s) − r(x)) × f ds, and where x <= x_c the same of the contact force                        (S96)
double BeamLoads::moment(double x) const {
    integral_.weights(x, weights_.data());
    weights_ = rule_.w - weights_;
    Vec2 force{weights_.dot(force_x_), weights_.dot(force_y_)};
    double turn = weights_.dot(turn_);
    if (contact_x_ && x <= *contact_x_) {
        force = force + contact_force_;
        turn += contact_turn_;
    }
    BeamPoint p;
    model_->point(x, p);
    return turn - cross(p.r, force);
}

// The largest of the values at the root, the contact and the nodes, and of what parabolas find beside it.
Vec2 BeamLoads::largest_moment() const {
    const auto size = [this](double x) { return std::fabs(moment(x)); };
    std::vector<Vec2> stations{{0, size(0)}};
    const Eigen::VectorXd fx = beyond_ * force_x_, fy = beyond_ * force_y_, turn = beyond_ * turn_;
    for (Eigen::Index k = 0; k < rule_.x.size(); ++k) {
        const double x = rule_.x[k];
        const bool inside = contact_x_ && x <= *contact_x_;
        if (contact_x_ && !inside && stations.back().x < *contact_x_)
            stations.push_back({*contact_x_, size(*contact_x_)});
        const Vec2 force = Vec2{fx[k], fy[k]} + (inside ? contact_force_ : Vec2{});
        stations.push_back({x, std::fabs(turn[k] + (inside ? contact_turn_ : 0) - cross({x_[k], y_[k]}, force))});
    }
    if (contact_x_ && stations.back().x < *contact_x_) stations.push_back({*contact_x_, size(*contact_x_)});
    const auto best = std::ranges::max_element(stations, {}, &Vec2::y);
    Vec2 top = *best;
    const auto climb_between = [&](const Vec2& left, const Vec2& right) {
        const double middle = 0.5 * (left.x + right.x);
        const Vec2 found = climb(size, left, {middle, size(middle)}, right, top.y, kNegligibleRise * top.y);
        if (found.y > top.y) top = found;
    };
    if (best != stations.begin()) climb_between(*(best - 1), *best);
    if (best + 1 != stations.end()) climb_between(*best, *(best + 1));
    return top;
}

// The axis holds the beam against d'Alembert's forces, weight and contact force                            (S97)
Vec2 BeamLoads::pivot_force() const {
    const Vec2 load{rule_.w.dot(force_x_), rule_.w.dot(force_y_)};
    return -(load + (contact_x_ ? contact_force_ : Vec2{}));
}

}  // namespace beamcam::sim
