//! What a controller calls the columns: beside a set point, its input is what it reads, and its output is what it puts out.

use super::Quantity;
use super::header::{Field, Role, shorten};
use super::resembling::{is_set_point, resembles};

const INPUT: Role = Role::Measured(Quantity::Input);
const OUTPUT: Role = Role::Measured(Quantity::Output);

/// Gives the columns of a controller's log the roles that they have in the loop, and says so. A set point is wanted of what comes
/// out: where another column comes nearer to it than the one that is called output, that one is the controller's.
pub(super) fn as_in_the_loop(
    fields: &mut [Field],
    rows: impl Iterator<Item = Vec<Option<f64>>>,
) -> Option<String> {
    let wanted = fields.iter().position(|f| is_set_point(&f.name))?;
    let put_out = fields
        .iter()
        .position(|f| f.role == Some(OUTPUT) && f.name.eq_ignore_ascii_case("output"))?;
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
    let nearest = distances
        .iter()
        .enumerate()
        .filter(|(_, (_, count))| *count > 0)
        .min_by(|(_, a), (_, b)| (a.0 / a.1 as f64).total_cmp(&(b.0 / b.1 as f64)))
        .map(|(k, _)| k)
        .filter(|k| *k != put_out)?;
    let another = |(k, field): (usize, &Field)| k != nearest && field.role == Some(INPUT);
    if fields.iter().enumerate().any(another) {
        return None;
    }
    let moves = matches!(
        fields[nearest].role,
        Some(Role::Measured(Quantity::Position | Quantity::Velocity))
    );
    fields[put_out].role = Some(INPUT);
    if !moves {
        fields[nearest].role = Some(OUTPUT);
    }
    let [aim, output, own] = [wanted, nearest, put_out].map(|k| shorten(&fields[k].name));
    Some(format!(
        "'{output}' comes nearer to '{aim}' than '{own}' does: '{own}' is taken for what a controller put out, which is the input here."
    ))
}
