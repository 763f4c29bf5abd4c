//! `fretwork contact-patch`: from load, radii and moduli to the contact patch, its slip and its
//! wear.

use super::Failure;
use super::output::{answer, answer_json};
use crate::experiments::contact_patch::{self, ACCEPTABLE, Question};
use crate::shipped::search_path;
use clap::Args;
use clap::builder::{PossibleValue, PossibleValuesParser};
use std::path::PathBuf;

/// Text below the options of the help.
pub const EXAMPLES: &str = "\
Numbers have units as one writes them (75kN, '75 kN', 0.46m, 210GPa, '260 HBW', 0.5%); without a unit they are in SI units. A load per
length (13MN/m) is that of a line contact. Ranges are 0.4, 0.40+-0.03 or 0.3..0.5.

Examples:
  A wheel on a rail:
    fretwork contact-patch --load 75kN --radius 0.46m,flat --across flat,0.30m --material wheel_steel_er7,rail_steel_r260
  the same rolling with a creepage, friction and wear:
    ... --friction 0.3..0.5 --creepage 0.5% --speed 30m/s --wear 1e-4..1e-3
  A ball that frets on a flat:
    fretwork contact-patch --load 50N --radius 10mm --material rail_steel_r260 --friction 0.6 --displacement 5um
  Two cylinders with a tangential force:
    fretwork contact-patch --load 179N/mm --radius 1m,1m --young 210GPa --poisson 0.3 --friction 0.3 --force 20N/mm
  Friction from runs of a window, under the pressure and between the steels of the patch:
    ... --creepage 0.5% --friction-of results/creep_1 --friction-of results/creep_2

Exit code: 0 answered, 2 wrong input. docs/steel_to_number.md goes from such a patch to friction and wear with an interval.";

#[derive(Args, Debug)]
pub struct ContactPatchArgs {
    /// Normal load: a force, or a force per length for a line contact
    #[arg(long, value_name = "FORCE", allow_hyphen_values = true)]
    load: String,
    /// Radii of the two bodies along the motion; `flat` is a plane, a negative radius is concave,
    /// one alone is against a plane
    #[arg(
        long,
        value_name = "R1[,R2]",
        value_delimiter = ',',
        required = true,
        allow_hyphen_values = true
    )]
    radius: Vec<String>,
    /// Radii across the motion; as --radius by default
    #[arg(
        long,
        value_name = "R1[,R2]",
        value_delimiter = ',',
        allow_hyphen_values = true
    )]
    across: Vec<String>,
    /// Materials of the two bodies, by their names in materials/; one alone is that of both
    #[arg(long, value_name = "M1[,M2]", value_delimiter = ',')]
    material: Vec<String>,
    /// Young's moduli, in place of those of the materials
    #[arg(long, value_name = "E1[,E2]", value_delimiter = ',')]
    young: Vec<String>,
    /// Poisson's ratios, in place of those of the materials
    #[arg(long, value_name = "NU1[,NU2]", value_delimiter = ',')]
    poisson: Vec<String>,
    /// Hardnesses, in place of those of the materials ('260 HBW', 2.5GPa)
    #[arg(long, value_name = "H1[,H2]", value_delimiter = ',')]
    hardness: Vec<String>,
    /// Yield stress of the softer body; by default those of its material, before and after it has
    /// hardened, or the flow stress, its hardness over 2.8
    #[arg(long = "yield", value_name = "STRESS")]
    yield_stress: Option<String>,
    /// Friction coefficient, for slip and rolling
    #[arg(long, value_name = "RANGE")]
    friction: Option<String>,
    /// Take the coefficient of sliding from this run; repeat for runs with other seeds, whose
    /// scatter gives the interval
    #[arg(long = "friction-of", value_name = "DIR")]
    runs: Vec<PathBuf>,
    /// Take these runs although they are not trustworthy (untrusted), or differ from each other
    /// (inputs) or from the patch in materials, pressure, or motion (drive)
    #[arg(
        long,
        value_name = "WHAT",
        value_delimiter = ',',
        requires = "runs",
        value_parser = PossibleValuesParser::new(ACCEPTABLE.map(|(name, doc)| PossibleValue::new(name).help(doc)))
    )]
    accept: Vec<String>,
    /// Tangential force: what sticks under it
    #[arg(long, value_name = "FORCE", allow_hyphen_values = true)]
    force: Option<String>,
    /// Amplitude of the displacement of distant points in fretting: what sticks, and how far the
    /// middle slips
    #[arg(long, value_name = "LENGTH")]
    displacement: Option<String>,
    /// Longitudinal creepage in rolling: adhesion, T gamma
    #[arg(long, value_name = "SHARE", allow_hyphen_values = true)]
    creepage: Option<String>,
    /// Speed of rolling
    #[arg(long, value_name = "SPEED")]
    speed: Option<String>,
    /// Archard's wear coefficient K, a pure number: k = K/H with the hardness of each body
    #[arg(long, value_name = "RANGE")]
    wear: Option<String>,
    /// Width of the window of a third body; by default a fiftieth of the patch
    #[arg(long, value_name = "LENGTH")]
    window: Option<String>,
    /// Print JSON, in SI units
    #[arg(long)]
    json: bool,
    /// Words that belong to no option
    #[arg(hide = true)]
    rest: Vec<String>,
}

pub fn contact_patch(args: &ContactPatchArgs) -> Result<(), Failure> {
    if let Some(word) = args.rest.first() {
        return Err(Failure::Usage(format!(
            "`{word}` belongs to no option: write a number and its unit as one word (75kN, or '75 kN'), and the values of two bodies with a comma (0.46m,flat)"
        )));
    }
    let question = Question {
        load: args.load.clone(),
        radius: args.radius.clone(),
        across: args.across.clone(),
        material: args.material.clone(),
        young: args.young.clone(),
        poisson: args.poisson.clone(),
        hardness: args.hardness.clone(),
        yield_stress: args.yield_stress.clone(),
        friction: args.friction.clone(),
        runs: args.runs.clone(),
        accept: args.accept.clone(),
        force: args.force.clone(),
        displacement: args.displacement.clone(),
        creepage: args.creepage.clone(),
        speed: args.speed.clone(),
        wear: args.wear.clone(),
        window: args.window.clone(),
    };
    let found = contact_patch::answer(&question, &search_path());
    let found = found.map_err(|e| {
        let e = e.replacen("yield_stress: ", "yield: ", 1);
        Failure::of_options::<ContactPatchArgs>(e)
    })?;
    if args.json {
        let text = serde_json::to_string_pretty(&found);
        return answer_json(&text.map_err(|e| Failure::Failed(e.to_string()))?);
    }
    answer(&found.text())
}
