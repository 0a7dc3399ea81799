//! The head's own stages: the younger face (VI), and how the head sits over the chest (D30).

use super::memo::View;
use crate::character::MeshKind;
use crate::error::{Result, Warning};
use crate::face::head::HeadFrame;
use crate::face::outline::{Outline, rounded};
use crate::face::rows::{FaceAim, Rows};
use crate::face::seat::Seat;
use crate::face::stage::{FaceBinding, HeadPoints, YoungFace};
use crate::geometry::bounds;
use crate::options::{FaceCurve, Stage};
use crate::parallel;
use crate::room::{self, Of};
use crate::shape::Measured;
use crate::shape::field::{Binding, Field, Finish};
use crate::shape::measured::is_of_head;
use crate::shape::placement::Body;
use crate::shape::product::anatomy::Proportions;
use crate::shape::product::coefficients::lost;
use crate::shape::product::face_input::head_frame;
use crate::shape::product::part::Part;
use glam::DVec3;
use std::sync::Arc;

/// How much of the head's own stages is done, 0 where they are not asked for or the figure keeps its number of heads, which
/// leaves a character made like itself as it is, to 1.
pub fn growth(view: &View) -> Result<f64> {
    let (body, measured) = (view.body()?, view.measured()?);
    let landmarks = &measured.anatomy.landmarks;
    let heads = body.heads.filter(|_| view.options.stage == Stage::Face && landmarks.trunk.is_none());
    Ok(heads.map_or(0.0, |heads| lost(landmarks.heights.heads(), heads)))
}

/// Where `body` puts the head; `None` in paper mode.
pub fn frame_after(body: &Body, measured: &Measured) -> Option<HeadFrame> {
    let length = body.parts()?.after().head_length();
    let chin = head_frame(&measured.anatomy).origin;
    Some(HeadFrame { origin: body.field.place(chin, &Binding::to(Part::Head)), length })
}

/// Where `field`, which leaves the head at `frame`, takes its points, in head lengths before and after.
pub fn head_map(measured: &Measured, field: &Field, frame: HeadFrame) -> impl Fn(DVec3) -> DVec3 {
    let before = head_frame(&measured.anatomy);
    move |p| frame.to_unit(field.place(before.from_unit(p), &Binding::to(Part::Head)))
}

/// The box of the face map: around what the head moves, in body or face meshes, as the body leaves it; in product mode as
/// high as from chin to crown, and as wide as nothing for a curve, which asks for heights alone.
pub fn face_box(view: &View) -> Result<Option<(DVec3, DVec3)>> {
    let (body, measured) = (view.body()?, view.measured()?);
    let ends = body.parts().map(|parts| [parts.after().chin, parts.after().crown]);
    if let (Some([chin, crown]), FaceCurve::F4 | FaceCurve::F2) = (ends, view.options.face_curve) {
        return Ok(Some((DVec3::Y * chin, DVec3::Y * crown)));
    }
    let offsets = view.offsets()?;
    let figure = &*measured.figure;
    let placement = body.placement(figure, &body.field, &offsets, view.threads());
    let is_of_face = |&vertex: &usize| {
        let kind = figure.kind(vertex);
        (kind == MeshKind::Body || kind.is_of_face()) && is_of_head(figure, vertex)
    };
    let vertices = (0..figure.positions.len()).filter(is_of_face);
    let (low, high) = bounds(vertices.map(|vertex| placement.vertex(vertex)));
    let [bottom, top] = ends.unwrap_or([low.y, high.y]);
    Ok((low.x <= high.x).then_some((low.with_y(bottom), high.with_y(top))))
}

/// The outline of the head as body and face map leave it, and how it stands over the trunk.
pub fn outline(view: &View) -> Result<Option<Outline>> {
    let (body, measured, sources) = (view.body()?, view.measured()?, view.outline_sources()?);
    let (Some(frame), Some(parts)) = (frame_after(&body, &measured), body.parts()) else { return Ok(None) };
    let field = body.with_face(view.face()?.shape);
    let placement = body.placement(&measured.figure, &field, &[], view.threads());
    let points = placement.vertices(&sources.vertices);
    Ok(Outline::of(&sources, &points, frame, parts.after().shoulder_line))
}

/// The face step beyond Eqs. 12 and 13: of the target's face as they leave it.
pub fn make_young(view: &View) -> Result<Option<Arc<YoungFace>>> {
    let (measured, body, shape) = (view.measured()?, view.body()?, view.face()?.shape);
    let frame = frame_after(&body, &measured);
    let (Some(face), Some(frame), Some(heads)) = (&measured.face, frame, body.heads) else { return Ok(None) };
    let field = body.with_face(shape);
    let place = head_map(&measured, &field, frame);
    // A head that is only moved or made larger has the same face, to the bit.
    let face = face.mapped(|p| place(p).to_array().map(rounded).into());
    let shape = view.style().shape();
    let eyes = shape.and_then(|shape| shape.face).map(|face| (face.eye_size, face.eye_height));
    let head = shape.and_then(|shape| shape.proportions.as_ref()).map(Proportions::head_width);
    let aim = FaceAim::new(heads, eyes, head);
    let outline = view.outline()?;
    let rows = Rows::new(&face, Option::as_ref(&outline), &aim, &view.options.features(), view.options.smile);
    if rows.kernels.is_empty() {
        return Ok(None);
    }
    room::ask(Of::Young, body.bindings.of_head.len())?;
    let placement = body.placement(&measured.figure, &field, &[], view.threads());
    let things: Vec<Vec<DVec3>> =
        view.parts()?.parts.things.iter().map(|vertices| placement.vertices(vertices)).collect();
    let (vertices, count) = (&body.bindings.of_head[..], body.placed.len());
    let points = parallel::collect(view.threads(), vertices.len(), parallel::FEW, |index| {
        let vertex = vertices[index] as usize;
        let binding = &body.bindings.vertices[vertex];
        let of_face = binding.parts().map_or(FaceBinding::None, |parts| parts.face);
        (field.squash(body.placed[vertex], binding), of_face)
    });
    let head = HeadPoints { vertices, points: &points, count };
    // What is the same as last time is taken from there.
    let known = view.before::<Option<Arc<YoungFace>>>().and_then(|known| (*known).clone());
    let young = YoungFace::new(frame, rows, &things, &head, known.as_deref(), view.threads());
    Ok(Some(Arc::new(young)))
}

/// How the head goes back over the chest.
pub fn seat(view: &View) -> Result<Option<Seat>> {
    Ok(view.outline()?.as_ref().as_ref().and_then(Seat::new))
}

/// The field all the way: body, face, flow and seat, as much of each as the options ask for.
pub fn field(view: &View) -> Result<Field> {
    let (measured, body, options) = (view.measured()?, view.body()?, &view.options);
    let finish = Finish { face: view.face()?.shape, ..body.finish(&measured.figure, *view.whole()?) };
    let mut field = Field { finish, ..body.field.clone() };
    let growth = growth(view)?;
    if growth * options.youth > 0.0 {
        field.young = (*view.young()?).clone();
        field.youth = growth * options.youth;
    }
    if options.seat * growth != 0.0 {
        field.seat = view.seat()?.as_ref().clone().map(Arc::new);
        field.seat_amount = growth * options.seat;
    }
    Ok(field)
}

/// A warning where a face is there, and no eyes are known that could grow.
pub fn eyes_not_found(view: &View) -> Result<Option<Warning>> {
    let (measured, options) = (view.measured()?, &view.options);
    let is_done = growth(view)? > 0.0;
    let are_found = measured.face.as_ref().is_none_or(|face| face.eyes.is_some());
    if !is_done || are_found || options.youth * options.youth_eye == 0.0 {
        return Ok(None);
    }
    let message = if view.character().face_hints.is_empty() {
        "no eyes were found on the face, so they keep their size: say where they are, or that their meshes are eyes"
    } else {
        "no eyes are where they are said to be, so they keep their size: give places on the face, left and right of its middle"
    };
    Ok(Some(Warning::new("face_eyes_not_found", message).about("eyes")))
}
