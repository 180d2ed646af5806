//! scratch
use igimp_assembly::Method;
use igimp_cases::{column::Column,von_mises_slope::VonMisesSlope,footing::Footing,mohr_coulomb_slope::MohrCoulombSlope};
use std::time::Instant;
fn main(){
 let what=std::env::args().nth(1).unwrap();
 let methods=[Method::impm(),Method::impm_bbar(),Method::igimp(),Method::igimp_bbar()];
 match what.as_str(){
 "column"=>for m in [Method::impm(),Method::igimp(),Method::igimp_bbar()]{for (young,cs) in [(10e3,[4,8,16,32,64,128,256]),(1e6,[4,8,16,32,64,128,256])]{ for c in cs{let t=Instant::now();match (Column{method:m.clone(),cells:c,young,..Default::default()}).run(){Ok(r)=>println!("{} E={young} {c}: {:.4e} max {:.3} top err {:.2e} it {} cuts {} {:.2}s {:?}",m.label(),r.stress_error,r.largest_error,(r.top-r.exact_top)/50.,r.report.iterations(),r.report.failures.len(),t.elapsed().as_secs_f64(),r.report.steps.last().unwrap().residuals),Err(e)=>println!("{c} {e:?}")}}}},
 "vm"=>for cell in [1.0,0.5]{for young in [1e8,1e6]{for m in &methods{let t=Instant::now();let s=VonMisesSlope{method:m.clone(),cell,young,..Default::default()};let r=s.run().unwrap();println!("{} h={cell} E={young}: osc {:.4} reached {} disp {:.3} it {} fails {} {:.2}s n={} {:?}",m.label(),s.oscillation(&r.particles),r.load_factor,r.displacement.rows.last().unwrap()[1],r.report.iterations(),r.report.failures.len(),t.elapsed().as_secs_f64(),r.particles.len(),r.report.times());}}},
 "limit"=>for cell in [1.0,0.5]{for f in [0.0,10.0]{for m in [&methods[3],&methods[2]]{let t=Instant::now();let mut s=VonMisesSlope{method:m.clone(),cell,young:1e8,load_factor:2.0,steps:40,..Default::default()};s.geometry.foundation=f;if f>0.0{s.geometry.crest=25.;s.geometry.toe=25.0;}let r=s.run().unwrap();println!("{} h={cell} found={f}: N={:.4} collapsed {} disp {:.3} it {} fails {} {:.2}s",m.label(),s.stability_number(r.load_factor),r.collapsed(),r.displacement.rows.last().unwrap()[1],r.report.iterations(),r.report.failures.len(),t.elapsed().as_secs_f64());for f in &r.report.failures{println!("   {:.4}->{:.4} {} {:?}",f.from,f.to,f.failure,f.residuals.last());}}}},
 "mc"=>for cell in [1.0,0.5]{for srf in [0.8,1.0,1.2,1.3,1.35,1.4]{let t=Instant::now();let r=MohrCoulombSlope{cell,..Default::default()}.run(srf).unwrap();println!("h={cell} srf={srf}: {:.4} {:?} it {} steps {} fails {} {:.2}s",r.displacement,r.verdict(),r.report.iterations(),r.report.steps.len(),r.report.failures.len(),t.elapsed().as_secs_f64());}},
 "footing"=>for (n,steps) in [(5,75),(9,75),(13,130)]{let t=Instant::now();let f=Footing{cells_per_width:n,steps,..Default::default()};let r=f.run().unwrap();print!("{n}: reached {} it {} fails {} {:.1}s {:?}:",r.reached,r.report.iterations(),r.report.failures.len(),t.elapsed().as_secs_f64(),r.report.times());for w in [0.02,0.05,0.1,0.2,0.3,0.5,0.75,1.0]{print!(" {:.3}",r.resistance_at(w));}println!();for f in &r.report.failures{println!("   {:.4}->{:.4} {} {:?}",f.from,f.to,f.failure,f.residuals);}},
 _=>{}}
}
