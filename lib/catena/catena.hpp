// The one include a user needs: models, analyses, results, scenes.
//
//   Model model = ...                       model/model.hpp, model/model_add.hpp, elements/all.hpp
//   Kinematics, Dynamics, Assembler ...     analysis/
//   ColumnSet, ResultStorage, RowSink       columns/, results/
//   KinematicDerivatives, StaticDerivatives, MotionDerivatives    analysis/sensitivity/: of models over DesignScalar
//   EquilibriumGradient, MotionAdjoint      analysis/statics/, analysis/sensitivity/: by any number of parameters
//   MeasureSet, optimise_design             analysis/measures/, analysis/design/
//   Scene::load(path).run()                 scene/loading/scene.hpp
//   run_scene(path, options, sink)          scene/running/scene_runner.hpp
//   RunRecorder, draw_record, plot_record   scene/viewing/: figures, plots and pages of a run
//
// Units SI, radians. Numerical outcomes are values (base/status.hpp); exceptions are for misuse and bad scenes.
#pragma once

#include "catena/analysis/batch/batch.hpp"
#include "catena/analysis/design/design_problem.hpp"
#include "catena/analysis/dynamics/dynamics.hpp"
#include "catena/analysis/kinematics/kinematics.hpp"
#include "catena/analysis/measures/measure_set.hpp"
#include "catena/analysis/pose/mobility.hpp"
#include "catena/analysis/sensitivity/kinematic_derivatives.hpp"
#include "catena/analysis/sensitivity/motion_adjoint.hpp"
#include "catena/analysis/sensitivity/motion_derivatives.hpp"
#include "catena/analysis/sensitivity/static_derivatives.hpp"
#include "catena/analysis/statics/equilibrium_gradient.hpp"
#include "catena/columns/column_set.hpp"
#include "catena/elements/all.hpp"
#include "catena/model/model_add.hpp"
#include "catena/results/column_rows.hpp"
#include "catena/results/result_storage.hpp"
#include "catena/scene/loading/scene.hpp"
#include "catena/scene/viewing/record_figure.hpp"
#include "catena/scene/viewing/view_document.hpp"
#include "catena/scene/viewing/viewer_page.hpp"
