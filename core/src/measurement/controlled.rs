//! What a controller calls the columns: its input is what it reads, and its output is what it puts out.

use super::Quantity;
use super::header::{Field, Role, shorten};
use super::resembling::{is_set_point, is_warm, resembles};
use crate::message::Message;
use crate::msg;

const INPUT: Role = Role::Measured(Quantity::Input);
const OUTPUT: Role = Role::Measured(Quantity::Output);

/// Gives the columns of a controller's log the roles that they have in the loop, and says so: where another column than
/// the one that is called output is what comes out, that one is the controller's.
pub(super) fn as_in_the_loop(
    fields: &mut [Field],
    rows: impl Iterator<Item = Vec<Option<f64>>>,
) -> Option<Message> {
    let put_out = fields
        .iter()
        .position(|f| f.role == Some(OUTPUT) && f.name.eq_ignore_ascii_case("output"))?;
    let own = shorten(&fields[put_out].name);
    let wanted = fields.iter().position(|f| is_set_point(&f.name));
    let (comes_out, nearer) = if let Some(wanted) = wanted {
        let nearest = nearest(fields, wanted, rows).filter(|k| *k != put_out)?;
        let [aim, output] = [wanted, nearest].map(|k| shorten(&fields[k].name));
        (nearest, Some([output, aim]))
    } else {
        let warm = only_warm(fields)?;
        (warm, None)
    };
    let another = |(k, field): (usize, &Field)| k != comes_out && field.role == Some(INPUT);
    if fields.iter().enumerate().any(another) {
        return None;
    }
    let moves = matches!(
        fields[comes_out].role,
        Some(Role::Measured(Quantity::Position | Quantity::Velocity))
    );
    fields[put_out].role = Some(INPUT);
    if !moves {
        fields[comes_out].role = Some(OUTPUT);
    }
    let own = Message::name(own);
    Some(if let Some(nearer) = nearer {
        let [output, aim] = nearer.map(Message::name);
        msg!(
            "'{}' stays closer to '{}' than '{}' does: '{}' is taken as the output of a controller, which is the \
             input here.",
            output,
            aim,
            &own,
            &own
        )
    } else {
        let warm = Message::name(shorten(&fields[comes_out].name));
        msg!(
            "'{}' is what comes out of the plant: '{}' is taken as the output of a controller, which is the input \
             here.",
            warm,
            own
        )
    })
}

/// The column that comes nearest to a set point, which is wanted of what comes out.
fn nearest(
    fields: &[Field],
    wanted: usize,
    rows: impl Iterator<Item = Vec<Option<f64>>>,
) -> Option<usize> {
    let is_free = |(k, field): (usize, &Field)| {
        let time = field.role == Some(Role::Time) || resembles(Role::Time, &field.name);
        k != wanted && !time && !is_set_point(&field.name)
    };
    let free: Vec<bool> = fields.iter().enumerate().map(is_free).collect();
    let mut distances = vec![(0.0, 0_usize); fields.len()];
    for row in rows {
        let value = |k: usize| row.get(k).copied().flatten().filter(|v| v.is_finite());
        let Some(aim) = value(wanted) else { continue };
        for (k, (sum, count)) in distances.iter_mut().enumerate().filter(|(k, _)| free[*k]) {
            if let Some(value) = value(k) {
                *sum += (value - aim).abs();
                *count += 1;
            }
        }
    }
    let seen = distances
        .iter()
        .enumerate()
        .filter(|(_, (_, count))| *count > 0);
    let mean = |(sum, count): &(f64, usize)| sum / *count as f64;
    seen.min_by(|(_, a), (_, b)| mean(a).total_cmp(&mean(b)))
        .map(|(k, _)| k)
}

/// The only temperature, which is never put in, where nothing else is called as an input is.
fn only_warm(fields: &[Field]) -> Option<usize> {
    let mut warm =
        (0..fields.len()).filter(|k| is_warm(&fields[*k].name, fields[*k].unit.as_deref()));
    let only = warm.next().filter(|_| warm.next().is_none())?;
    let acts = |(k, f): (usize, &Field)| k != only && resembles(INPUT, &f.name);
    (!fields.iter().enumerate().any(acts)).then_some(only)
}
