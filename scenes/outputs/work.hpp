// Counts of the work of a run, by which tests prove that nothing unnecessary is done.
#pragma once

namespace beamcam::scenes {

struct Work {
    long integrations = 0;  // of equations of motion, except for sweeps; a horizon takes two
    long steps = 0, rhs_evaluations = 0, gap_evaluations = 0;
    long sweep_points = 0;                                                   // computed
    long font_sets = 0, gl_contexts = 0, encoder_modules = 0, encoders = 0;  // loaded or opened
    long frames_drawn = 0, figures_drawn = 0;
    long bodies_drawn = 0;     // drawn by OpenGL; a frame whose mechanism is unchanged reuses the last one
    long frames_repeated = 0;  // of films: equal to the previous frame, neither drawn nor converted
    long frames_encoded = 0;
    long frames_left = 0;  // of sequences: up to date
    long files_written = 0, files_left = 0;
    long bytes_written = 0;
};

// Calls visit(name, value) for every count, in the order of the output.
template <class Visit>
void for_each_count(const Work& w, Visit visit) {
    visit("integrations", w.integrations);
    visit("steps", w.steps);
    visit("rhs_evaluations", w.rhs_evaluations);
    visit("gap_evaluations", w.gap_evaluations);
    visit("sweep_points", w.sweep_points);
    visit("font_sets", w.font_sets);
    visit("gl_contexts", w.gl_contexts);
    visit("encoder_modules", w.encoder_modules);
    visit("encoders", w.encoders);
    visit("frames_drawn", w.frames_drawn);
    visit("figures_drawn", w.figures_drawn);
    visit("bodies_drawn", w.bodies_drawn);
    visit("frames_repeated", w.frames_repeated);
    visit("frames_encoded", w.frames_encoded);
    visit("frames_left", w.frames_left);
    visit("files_written", w.files_written);
    visit("files_left", w.files_left);
    visit("bytes_written", w.bytes_written);
}

}  // namespace beamcam::scenes
