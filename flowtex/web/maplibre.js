// Built from client/src by client/build.js; change that instead.
/*! Holds parts of gl-matrix, of which this is the licence:

Copyright (c) 2015-2025, Brandon Jones, Colin MacKenzie IV.

Permission is hereby granted, free of charge, to any person obtaining a copy
of this software and associated documentation files (the "Software"), to deal
in the Software without restriction, including without limitation the rights
to use, copy, modify, merge, publish, distribute, sublicense, and/or sell
copies of the Software, and to permit persons to whom the Software is
furnished to do so, subject to the following conditions:

The above copyright notice and this permission notice shall be included in
all copies or substantial portions of the Software.

THE SOFTWARE IS PROVIDED "AS IS", WITHOUT WARRANTY OF ANY KIND, EXPRESS OR
IMPLIED, INCLUDING BUT NOT LIMITED TO THE WARRANTIES OF MERCHANTABILITY,
FITNESS FOR A PARTICULAR PURPOSE AND NONINFRINGEMENT. IN NO EVENT SHALL THE
AUTHORS OR COPYRIGHT HOLDERS BE LIABLE FOR ANY CLAIM, DAMAGES OR OTHER
LIABILITY, WHETHER IN AN ACTION OF CONTRACT, TORT OR OTHERWISE, ARISING FROM,
OUT OF OR IN CONNECTION WITH THE SOFTWARE OR THE USE OR OTHER DEALINGS IN
THE SOFTWARE. */
/*! Holds parts of zarrita, of which this is the licence:

MIT License

Copyright (c) 2020-2023 Trevor Manz

Permission is hereby granted, free of charge, to any person obtaining a copy
of this software and associated documentation files (the "Software"), to deal
in the Software without restriction, including without limitation the rights
to use, copy, modify, merge, publish, distribute, sublicense, and/or sell
copies of the Software, and to permit persons to whom the Software is
furnished to do so, subject to the following conditions:

The above copyright notice and this permission notice shall be included in all
copies or substantial portions of the Software.

THE SOFTWARE IS PROVIDED "AS IS", WITHOUT WARRANTY OF ANY KIND, EXPRESS OR
IMPLIED, INCLUDING BUT NOT LIMITED TO THE WARRANTIES OF MERCHANTABILITY,
FITNESS FOR A PARTICULAR PURPOSE AND NONINFRINGEMENT. IN NO EVENT SHALL THE
AUTHORS OR COPYRIGHT HOLDERS BE LIABLE FOR ANY CLAIM, DAMAGES OR OTHER
LIABILITY, WHETHER IN AN ACTION OF CONTRACT, TORT OR OTHERWISE, ARISING FROM,
OUT OF OR IN CONNECTION WITH THE SOFTWARE OR THE USE OR OTHER DEALINGS IN THE
SOFTWARE. */
function jr(a){let e=a>>10&31,t=a&1023,r;return e===0?r=t*2**-24:e===31?r=t?NaN:1/0:r=(1024+t)*2**(e-25),a&32768?-r:r}var _e=Float32Array.
from({length:65536},(a,e)=>jr(e)),$r=new Float32Array(1),Wr=new Uint32Array($r.buffer);function lr(a){$r[0]=a;let e=Wr[0]>>>
16&32768,t=Wr[0]&2147483647;return t>=1199566848?e|(t>2139095040?32256:31744):t<947912704?e|Math.round(Math.abs(a)*2**24):
e|t-93952e4>>>13}function Yr(a,e,t,r){let[n,s]=[Math.max(e>>1,1),Math.max(t>>1,1)],i=new Uint16Array(n*s*r),o=(c,l,h)=>{
let u=(c+.5)*(h/l)-.5,m=Math.floor(u);return[m,Math.min(m+1,h-1),u-m]};for(let c=0,l=0;c<s;c+=1){let[h,u,m]=o(c,s,t);for(let p=0;p<
n;p+=1){let[f,d,b]=o(p,n,e);for(let g=0;g<r;g+=1){let y=(w,M)=>jr(a[(w*e+M)*r+g]),v=y(h,f)*(1-b)+y(h,d)*b,x=y(u,f)*(1-b)+
y(u,d)*b;i[l++]=lr(v*(1-m)+x*m)}}}return[i,n,s]}var qr=["coastlines","graticule"],we={critical:"critical_points",separatrices:"separatrices",nullclines:"nullclines"},qe={
saddle:8,orbit:4,leaving:2},Xr={float32:Float32Array,uint32:Uint32Array,float16:Uint16Array,uint16:Uint16Array,int16:Int16Array,
int8:Int8Array,uint8:Uint8Array};function hr({low:a,high:e,log:t}){if(!t)return n=>(n-a)/(e-a||1);let r=Math.log(e/a)||1;
return n=>Math.log(Math.max(n,a)/a)/r}function me(a){return a.variant.includes("FLOWTEX_SIGNFREE")}function K(a){return Number(a.split("/")[1])}function Me(a,e,{
scalars:t}){let[r,n,s="0"]=a.split("/"),i=t.choices[Number(s)]?.steps??t.steps;return r==="scalars"&&Number(n)===e&&i>1}
function ue(a){let[e,t,r,n,...s]=a.split("/");return e==="tile"?[[t,r,n].join("/"),s.join("/")]:null}function Jr(a,e){let t=ArrayBuffer.
isView(e)?new Uint8Array(e.buffer,e.byteOffset,e.byteLength):new Uint8Array(e),{name:r,dtype:n,shape:s,digest:i}=a,o=Xr[n];
if(!o)throw new Error(`a part has the type "${n}"; expected ${Object.keys(Xr).join(", ")}`);return{name:r,shape:s,digest:i,
data:new o(t.slice().buffer)}}function Zr(a){let[e,t]=mr(new Uint8Array(a)),r=t;return e.map(n=>{let s=new Uint8Array(a,
r,n.bytes);return r+=n.bytes,n.differences===void 0?Jr(n,s):en(n,s)})}function mr(a){let e=4+new DataView(a.buffer,a.byteOffset).
getUint32(0,!0);return[JSON.parse(new TextDecoder().decode(a.subarray(4,e))),e]}async function Qr(a,e){return en(a,new Uint8Array(
await Ua(e).arrayBuffer()))}function Ua(a){let e=atob(a),t=new Uint8Array(e.length);for(let r=0;r<t.length;r+=1)t[r]=e.charCodeAt(
r);return new Response(new Blob([t]).stream().pipeThrough(new DecompressionStream("gzip")))}var Kr={1:Uint8Array,2:Uint16Array,
4:Uint32Array};function en(a,e){let{shape:t,differences:r=[0,0],scale:n=null}=a,s=t.reduce((u,m)=>u*m,1),i=s?e.length/s:
1;if(!(i in Kr))throw new Error(`the packing of the part "${a.name}" is invalid`);let[o,c]=t.length>2?t.slice(-2):[...t,
1].slice(-2),l=new Kr[i](s);for(let u=0,m=0;u<c;u+=1)for(let p=u;p<s;p+=c,m+=1){let f=0;for(let d=0;d<i;d+=1)f|=e[d*s+m]<<
8*d;l[p]=f>>>1^-(f&1)}let h=o*c;for(let u=0;u<r[0];u+=1)for(let m=h;m<s;m+=1)l[m]+=l[m-h];for(let u=0;u<r[1];u+=1)for(let m=0;m<
s;m+=h)for(let p=m+c;p<m+h;p+=1)l[p]+=l[p-c];return Jr(a,n?Da(l,n.map(u=>2**u)):l)}function Da(a,e){let t=e.length;return a instanceof
Uint16Array?a.map((r,n)=>lr((r<<16>>16)*e[n%t])):new Float32Array(new Float64Array(a).map((r,n)=>(r|0)*e[n%t]))}var ur=1e-6,Je=typeof Float32Array<"u"?Float32Array:Array;var Rc=Math.PI/180,Lc=180/Math.PI;function rn(a,e){if(a===e){var t=e[1],r=e[2],n=e[5];a[1]=e[3],a[2]=e[6],a[3]=t,a[5]=e[7],a[6]=r,a[7]=n}else a[0]=e[0],a[1]=
e[3],a[2]=e[6],a[3]=e[1],a[4]=e[4],a[5]=e[7],a[6]=e[2],a[7]=e[5],a[8]=e[8];return a}function nn(a,e,t){var r=t[0],n=t[1],s=t[2],i=Math.sqrt(r*r+n*n+s*s),o,c,l;return i<ur?null:(i=1/i,r*=i,n*=i,s*=i,o=Math.
sin(e),c=Math.cos(e),l=1-c,a[0]=r*r*l+c,a[1]=n*r*l+s*o,a[2]=s*r*l-n*o,a[3]=0,a[4]=r*n*l-s*o,a[5]=n*n*l+c,a[6]=s*n*l+r*o,
a[7]=0,a[8]=r*s*l+n*o,a[9]=n*s*l-r*o,a[10]=s*s*l+c,a[11]=0,a[12]=0,a[13]=0,a[14]=0,a[15]=1,a)}function za(){var a=new Je(3);return Je!=Float32Array&&(a[0]=0,a[1]=0,a[2]=0),a}function sn(a){var e=a[0],t=a[1],r=a[2];return Math.sqrt(e*e+t*t+r*r)}function an(a,e,t){return a[0]=e[0]-t[0],a[1]=e[1]-t[1],a[2]=e[2]-t[2],a}function on(a,e,t){return a[0]=e[0]*t,a[1]=e[1]*t,a[2]=e[2]*t,a}function cn(a,e,t,r){return a[0]=e[0]+t[0]*r,a[1]=e[1]+t[1]*
r,a[2]=e[2]+t[2]*r,a}function ln(a,e){var t=e[0],r=e[1],n=e[2],s=t*t+r*r+n*n;return s>0&&(s=1/Math.sqrt(s)),a[0]=e[0]*s,a[1]=e[1]*s,a[2]=e[2]*
s,a}function hn(a,e){return a[0]*e[0]+a[1]*e[1]+a[2]*e[2]}function mn(a,e,t){var r=e[0],n=e[1],s=e[2],i=t[0],o=t[1],c=t[2];
return a[0]=n*c-s*o,a[1]=s*i-r*c,a[2]=r*o-n*i,a}function un(a,e,t){var r=e[0],n=e[1],s=e[2],i=t[3]*r+t[7]*n+t[11]*s+t[15];return i=i||1,a[0]=(t[0]*r+t[4]*n+t[8]*s+t[12])/
i,a[1]=(t[1]*r+t[5]*n+t[9]*s+t[13])/i,a[2]=(t[2]*r+t[6]*n+t[10]*s+t[14])/i,a}function pr(a,e,t){var r=e[0],n=e[1],s=e[2];
return a[0]=r*t[0]+n*t[3]+s*t[6],a[1]=r*t[1]+n*t[4]+s*t[7],a[2]=r*t[2]+n*t[5]+s*t[8],a}var Fc=(function(){var a=za();return function(e,t,r,n,s,i){var o,c;for(t||(t=3),r||(r=0),n?c=Math.min(n*t+r,e.length):c=
e.length,o=r;o<c;o+=t)a[0]=e[o],a[1]=e[o+1],a[2]=e[o+2],s(a,a,i),e[o]=a[0],e[o+1]=a[1],e[o+2]=a[2];return e}})();var z=a=>a,re=()=>[0,0,0],pn=a=>new Array(a).fill(0),O=(a,e)=>hn(z(a),z(e)),R=a=>sn(z(a)),S=(a,e)=>an(re(),z(a),z(e)),k=(a,e)=>on(
re(),z(a),e),V=(a,e)=>mn(re(),z(a),z(e)),U=a=>ln(re(),z(a)),P=(a,e,t=1)=>cn(re(),z(a),z(e),t);function Ze(a,e,t){let r=nn(
pn(16),t*Math.PI/180,z(e));return r===null?re():un(re(),z(a),r)}function N(a,e){let t=rn(pn(9),a);return pr(re(),z(e),t)}
function Q(a,e){return pr(re(),z(e),a)}function _(a,e,t){return Math.min(Math.max(a,e),t)}var Wa="own cmap";var fn=256;function ja({scalars:a},e,t,r){let{entries:n,flip:s,maps:i}=a,o=r?r.slice():new Uint8Array(4*n).fill(255),c=o.
length/4-1||1;return o.map((l,h)=>{let[u,m]=[h>>2,h&3],p=Math.round((s?c-u:u)/c*(fn-1));return m===3?l:e[3*(i.indexOf(t)*
fn+p)+m]})}function dn(a,{beyond:e}){let t=a.length/4,r=a instanceof Float32Array;return Float32Array.from({length:a.length+
12},(n,s)=>{let[i,o]=[s>>2,s&3],c=a[4*_(i-1,0,t-1)+o];return o===3?r?i?c:1:0:(i>t?e[i-t]:i?null:e[0])?.[o]??c/255})}function bn(a,e,t){let r={...a.scalars};e.scalars===!1&&(r.name=null);let n=r.choices.findIndex(({name:g})=>g===e.scalars);
if(n>=0){let{name:g,label:y,unit:v,steps:x,flat:w}=r.choices[n];Object.assign(r,{name:g,label:y,unit:v,steps:x,flat:w,number:n,
auto:!0})}if(e.cmap&&(r.cmap=e.cmap),Array.isArray(e.clim)&&([r.low,r.high]=e.clim),e.clim!==void 0&&(r.auto=!e.clim),r.
auto&&r.choices[r.number]){let{low:g,high:y,cmap:v=""}=r.choices[r.number],w=(g<0&&y>0||r.diverging.includes(v))&&r.diverging.
includes(r.cmap),M=Math.max(-g,y);[r.low,r.high]=w?[-M,M]:[g,y]}let{coastlines:s=a.earth?.coastlines,graticule:i=a.earth?.
graticule}=e,o=a.earth&&{...a.earth,coastlines:s,graticule:i},{opacity:c=a.opacity}=e,l={scalars:r,earth:o,opacity:c},[h,
u]=[t.get("maps"),t.get("cmap")?.data],m=u instanceof Float32Array,p=m&&(e.clim!==void 0||e.scalars!==void 0);if(!h||!(e.
cmap||p))return{colours:l,part:null};p&&Object.assign(r,{ticks:[],beyond:[null,null,r.beyond[2]]});let f=m&&!p,d=e.cmap?
ja(a,h.data,e.cmap,f?u:void 0):Uint8Array.from(u??[]),b=[Wa,e.cmap,f].join();return{colours:l,part:{name:"cmap",data:d,shape:[
d.length/4,4],digest:b}}}var fr=[0,0,1],gn=Math.sin(89*Math.PI/180),$a=.2,pe=a=>Math.tan(a*Math.PI/360),fe=class{flat;limits;aspect;state;start;pick=null;globe;homeHeight;nearest;constructor(e,t,r,n=1,s=0){
this.state=dr(e),this.start=dr(e),this.limits=t,this.flat=r,this.globe=s,this.aspect=n,this.homeHeight=this.height,this.
nearest=this.distance/t.closest}get height(){let{parallel:e,parallel_scale:t,view_angle:r}=this.state;return e?t:this.distance*
pe(r)}get distance(){return R(S(this.state.focal_point,this.state.position))}get zoom(){return this.homeHeight/this.height}get axes(){
let e=U(S(this.state.focal_point,this.state.position)),t=U(V(e,this.state.up));return[t,V(t,e),e]}sight(e){let{parallel:t,
position:r,view_angle:n}=this.state;return t?{eye:null,halfHeight:this.height,pixels:e}:{eye:r,halfHeight:pe(n),pixels:e}}get planes(){
let[e,t,r]=this.axes,{parallel:n,parallel_scale:s,view_angle:i}=this.state,{position:o,focal_point:c}=this.state,l=n?s:pe(
i);return[e,k(e,-1),t,k(t,-1)].map((h,u)=>{let m=u<2?l*this.aspect:l;if(n)return[...h,m-O(h,c)];let p=P(h,r,m);return[...p,
-O(p,o)]})}get eye(){return this.state.parallel?[...k(this.axes[2],-1),0]:[...this.state.position,1]}at(e){let t=this.axes[2];
if(this.state.parallel)return{height:this.height,ray:t};let r=S(e,this.state.position);return{height:O(r,t)*pe(this.state.
view_angle),ray:U(r)}}project(e){let[t,r]=this.axes,{height:n}=this.at(e);if(!(n>0))return null;let{parallel:s,position:i,
focal_point:o}=this.state,c=S(e,s?o:i);return[O(t,c)/n/this.aspect,O(r,c)/n]}pan(e,t){let[r,n]=this.axes,{height:s}=this;
this.shift(P(k(r,e*this.aspect*s),n,t*s))}rotate(e,t){if(this.globe)return this.roam(e,t);let{state:r,limits:n}=this,s=U(
r.up),i=S(r.position,r.focal_point);i=Ze(i,s,-n.turn*e*Math.min(this.aspect,n.widest_turn));let o=U(V(s,i));i=Ze(i,o,n.turn*
t),r.position=P(r.focal_point,i),r.up=U(V(i,o))}roam(e,t){let{state:r,limits:n,globe:s}=this,i=R(r.position),o=Math.max(
i-s,0)*pe(r.view_angle),c=r.parallel?r.parallel_scale:o,l=Math.min(c/s*180/Math.PI,n.turn),h=Math.hypot(r.position[0],r.
position[1])/i,u=Math.min(l*this.aspect/Math.max(h,$a),n.turn);this.turn(fr,-u*e);let[m]=this.axes,p=Math.abs(r.position[2])/
i,f=dr(r);this.turn(m,l*t),Math.abs(r.position[2])/i>Math.max(gn,p)&&(this.state=f);let[,,b]=this.axes,g=P(fr,b,-O(fr,b));
R(g)>1-gn&&(this.state.up=U(g))}turn(e,t){let{state:r}=this;for(let n of["position","focal_point","up"])r[n]=Ze(r[n],e,t)}zoomBy(e,t=0,r=0){
if(!Number.isFinite(e)||e<=0)return;this.flat||this.focusAt(t,r);let{farthest_zoom:n,deepest_zoom:s}=this.limits,i=_(e,n/
this.zoom,s/this.zoom),[o,c,l]=this.axes,h=this.height*(1-1/i);this.shift(P(k(o,t*this.aspect*h),c,r*h)),this.state.parallel?
this.state.parallel_scale/=i:this.approach(this.height/i,l)}ray(e,t){let[r,n,s]=this.axes,{height:i,state:o}=this,c=P(P(
o.focal_point,r,e*this.aspect*i),n,t*i);return o.parallel?[P(c,s,-this.distance),s]:[P(o.position,[0,0,0]),U(S(c,o.position))]}approach(e,t){
let r=Math.max(e/pe(this.limits.view_angle),this.nearest);this.state.position=P(this.state.focal_point,t,-r),this.state.
view_angle=Math.atan(e/r)*360/Math.PI}focusAt(e,t){let r=this.pick?.(e,t);if(!r)return;let n=this.axes[2],s=O(S(r,this.state.
position),n);s>0&&(this.state.focal_point=P(this.state.position,n,s))}shift(e){this.state.focal_point=P(this.state.focal_point,
e),this.state.position=P(this.state.position,e)}};function dr(a){let{position:e,focal_point:t,up:r}=a;return{...a,position:[
...e],focal_point:[...t],up:[...r]}}function G(a,e,t){let{state:r,aspect:n}=e,{center:s,extent:i,frame:o}=a,[c,l,h]=e.axes.map(E=>N(o,E)),u=E=>S(N(o,S(E,s)),
t),m=u(r.focal_point),p=k(t,-1),f=Math.max(.51*i,a.reach??0),d=new Array(16).fill(0),b=r.parallel?r.parallel_scale:pe(r.
view_angle);if([c.map(E=>E/b/n),l.map(E=>E/b)].forEach((E,T)=>{for(let L=0;L<3;L+=1)d[4*L+T]=E[L];d[12+T]=-O(E,m)}),r.parallel){
for(let E=0;E<3;E+=1)d[4*E+2]=h[E]/f;return d[14]=-O(h,p)/f,d[15]=1,d}let y=u(r.position),v=O(S(p,y),h),x=Math.max(v+f,.001*
f),w=Math.max(v-f,.001*x),M=(x+w)/(x-w),A=-2*x*w/(x-w);for(let E=0;E<3;E+=1)d[4*E+2]=h[E]*M,d[4*E+3]=h[E];return d[15]=-O(
h,y),d[14]=d[15]*M+A,d}function yn(a,[e,t],[r,n]){let s=[...a];for(let i=0;i<4;i+=1)s[4*i]=(s[4*i]-e*s[4*i+3])*r,s[4*i+1]=
(s[4*i+1]-t*s[4*i+3])*n;return s}var ae=8,xn=9,br=.2,Ya=1.4,vn=55,Xa=125,Ka=.5,qa=4,Ja=150,wn=4e-5,Mn=2e-6;function An(a,e,t,r,n){let s=Math.max(n-e,Math.
min(e/2,n),2)/a;if(t*(r+ae)<=s)return{scale:1,samples:r};let i=Math.min(xn,r),o=Math.sqrt(s/(i+ae)/t);return o<1?{scale:Math.
max(o,br),samples:i}:{scale:1,samples:_(Math.floor(s/t-ae),i,r)}}function En(a,e,t,r,n){if(!n)return vn;let s=Math.min(xn,
r),i=e+a*t*Ka**2*(s+ae);return _(i,vn,Xa)}function Sn(a,e,t,r,n){let s=e*r*(n+ae),i=Math.max(Math.min(3*t,Ja),t);return Math.
max(Math.floor(Math.max(a-t,i)/s),qa)}function Tn(a){return(2*a+ae)/(a+ae)}function _n(a,e,t,r,n,s){let i=Math.max(e-t,.05)/
(r*(n+ae)*s);return a+(i-a)*(i>a?.7:.3)}function Pn(a,e,t){let[r,n,s]=[a.grain,a.spacing,a.samples].map(Number),i=Math.max(
r*t,Math.min(r,1)),c=s*n*r*t/(e*i);return{u_grain:i,u_spacing:_(c,.1,Math.max(Ya,n))}}var Za=`#version 300 es
precision highp float;
precision highp int;
`,Qa=["flowtexPosition","flowtexCoordinate","flowtexNormal","flowtexNoise","flowtexScalar","flowtexCorners","flowtexRadi\
us"],gr=["u_slices","u_slicesNext","u_noiseImage","u_stepImage","u_cmap","u_shares"],Ae=class{graphics;entries=new Map;parallel=null;constructor(e){
this.graphics=e}findFeatures(){this.parallel=this.graphics.context.getExtension("KHR_parallel_shader_compile")}clear(){this.
entries.clear()}dispose(){for(let e of this.entries.values()){for(let t of e.shaders)this.graphics.free("Shader",t);this.
graphics.free("Program",e.program)}this.clear()}get(e,t,...r){let n=[e,t,...r].join("\0"),s=this.entries.get(n);return s||
this.entries.set(n,s=this.build(e,t,r)),!s.ready&&!s.error&&this.finish(s),s}build(e,t,r){let{graphics:n}=this,s=n.context,
i=n.counted(s.createProgram()),o=[s.VERTEX_SHADER,s.FRAGMENT_SHADER],c=Za+r.map(u=>`#define ${u}
`).join(""),l=[e,t].map((u,m)=>{let p=n.counted(s.createShader(o[m]));return s.shaderSource(p,u.startsWith("#version")?u:
c+u),s.compileShader(p),s.attachShader(i,p),p});return Qa.forEach((u,m)=>s.bindAttribLocation(i,m,u)),s.linkProgram(i),{
program:i,shaders:l,uniforms:new Map,...{ready:!1,error:"",warm:!1,price:wn}}}finish(e){let t=this.graphics.context,{program:r}=e,
n=this.parallel?.COMPLETION_STATUS_KHR;if(n&&!t.getProgramParameter(r,n))return;if(!t.getProgramParameter(r,t.LINK_STATUS)){
if(t.isContextLost())return;let o=[...e.shaders.map(c=>t.getShaderInfoLog(c)),t.getProgramInfoLog(r)].filter(Boolean).join(
`
`);e.error=o||"the driver gave no reason";return}for(let i of e.shaders)this.graphics.free("Shader",i);e.shaders=[];let s=t.
getProgramParameter(r,t.ACTIVE_UNIFORMS);for(let i=0;i<s;i+=1){let o=t.getActiveUniform(r,i),c=o&&t.getUniformLocation(r,
o.name);!o||!c||e.uniforms.set(o.name.replace(/\[0\]$/,""),{location:c,type:o.type})}t.useProgram(r),gr.forEach((i,o)=>{
let c=e.uniforms.get(i);c&&t.uniform1i(c.location,o)}),e.ready=!0}use(e,t){let r=this.graphics.context;r.useProgram(e.program);
for(let[n,s]of Object.entries(t)){let i=e.uniforms.get(n);if(!i)continue;let{location:o,type:c}=i,l=typeof s=="object"?s:
[Number(s)];c===r.FLOAT?r.uniform1fv(o,l):c===r.FLOAT_VEC2?r.uniform2fv(o,l):c===r.FLOAT_VEC3?r.uniform3fv(o,l):c===r.FLOAT_VEC4?
r.uniform4fv(o,l):c===r.FLOAT_MAT4?r.uniformMatrix4fv(o,!1,l):r.uniform1i(o,l[0])}}};var ei=4,ti=45,ri=[4,68],ni=Symbol.for("flowtex.gl/3"),yr=class{canvas=document.createElement("canvas");gl;programs;users=new Set;waiting=new Set;common=new Map;stock=new Map;tracings=new Map;objects=0;isLost=!1;floats=!1;scheduled=0;picker=null;smooth=null;constructor(){
this.canvas.width=this.canvas.height=16,this.gl=this.canvas.getContext("webgl2",{alpha:!0,antialias:!1,powerPreference:"\
high-performance"}),this.programs=new Ae(this),this.findFeatures(),this.canvas.addEventListener("webglcontextlost",e=>{e.
preventDefault(),this.isLost=!0,this.objects=0,this.programs.clear(),this.common.clear(),this.tracings.clear(),this.picker=
this.smooth=null;for(let t of this.users)t.lost()}),this.canvas.addEventListener("webglcontextrestored",()=>{this.isLost=
!1,this.findFeatures();for(let e of this.users)e.change()})}findFeatures(){let{gl:e}=this;if(!e)return;let t=["EXT_color\
_buffer_float","EXT_color_buffer_half_float"];this.floats=t.some(r=>e.getExtension(r)!==null),this.programs.findFeatures()}get context(){
if(!this.gl)throw new Error("WebGL2 is not available");return this.gl}leave(e){if(this.users.delete(e),this.waiting.delete(
e),!this.users.size){cancelAnimationFrame(this.scheduled),this.scheduled=0,this.programs.dispose();for(let t of[this.picker,
this.smooth])t&&this.freeTarget(t);this.picker=this.smooth=null,this.canvas.width=this.canvas.height=16}}request(e){this.
waiting.add(e),this.scheduled||=requestAnimationFrame(t=>this.run(t))}run(e){this.scheduled=0;let t=performance.now()+ti;
for(let r of[...this.waiting])if(this.waiting.delete(r),r.frame(e,t),performance.now()>t)break;this.waiting.size&&(this.
scheduled||=requestAnimationFrame(r=>this.run(r)))}counted(e){if(e===null)throw new Error("the graphics card has no memo\
ry left, or the context is lost");return this.objects+=1,e}free(e,t){if(t===null||this.isLost||!this.gl)return;this.objects-=
1,this.gl[`delete${e}`](t)}hold(e){if(!e.digest)return e;let t=this.stock.get(e.digest)??{part:e,users:0};return this.stock.
set(e.digest,{...t,users:t.users+1}),t.part}release(e){let t=e&&this.stock.get(e.digest);!e||!t||(t.users-=1,t.users||this.
stock.delete(e.digest))}target(e,t,r,n){let s=this.context,i=this.counted(s.createFramebuffer());s.bindFramebuffer(s.FRAMEBUFFER,
i);let c=[[e,s.COLOR_ATTACHMENT0],[s.DEPTH_COMPONENT24,s.DEPTH_ATTACHMENT]].map(([l,h])=>{let u=this.counted(s.createRenderbuffer());
return s.bindRenderbuffer(s.RENDERBUFFER,u),s.renderbufferStorageMultisample(s.RENDERBUFFER,n,l,t,r),s.framebufferRenderbuffer(
s.FRAMEBUFFER,h,s.RENDERBUFFER,u),u});return{frame:i,buffers:c}}freeTarget(e){this.free("Framebuffer",e.frame);for(let t of e.
buffers)this.free("Renderbuffer",t)}bindSmooth(e,t){let r=this.context,n=this.smooth;if(!n||n.width<e||n.height<t){let[s,
i]=[Math.max(e,n?.width??0),Math.max(t,n?.height??0)];n&&this.freeTarget(n);let o=this.target(r.RGBA8,s,i,ei);this.smooth=
{...o,width:s,height:i}}r.bindFramebuffer(r.FRAMEBUFFER,this.smooth?.frame??null)}copySmooth(e,t){let r=this.context;r.bindFramebuffer(
r.READ_FRAMEBUFFER,this.smooth?.frame??null),r.bindFramebuffer(r.DRAW_FRAMEBUFFER,null),r.disable(r.SCISSOR_TEST),r.blitFramebuffer(
0,0,e,t,0,0,e,t,r.COLOR_BUFFER_BIT,r.NEAREST),r.bindFramebuffer(r.FRAMEBUFFER,null)}numbers(e,t=1,r=1){let n=this.context;
this.picker??=this.target(n.RGBA32UI,...ri,0),n.bindFramebuffer(n.FRAMEBUFFER,this.picker.frame),n.viewport(0,0,t,r),n.disable(
n.SCISSOR_TEST),n.enable(n.DEPTH_TEST),n.clearBufferuiv(n.COLOR,0,[0,0,0,0]),n.clear(n.DEPTH_BUFFER_BIT),e();let s=new Uint32Array(
4*t*r);return n.readPixels(0,0,t,r,n.RGBA_INTEGER,n.UNSIGNED_INT,s),n.bindFramebuffer(n.FRAMEBUFFER,null),s}};function Rn(){
let a=globalThis;return a[ni]??=new yr}function Qe(a,e,t){let{width:r,height:n,layers:s,channels:i,levels:o}=t,c=a.getParameter(a.MAX_TEXTURE_SIZE),l=a.getParameter(
a.MAX_ARRAY_TEXTURE_LAYERS);if(Math.max(r,n)>c||s>l)throw new Error(`a texture of ${r} x ${n} texels in ${s} layers is n\
eeded, but this graphics card supports at most ${c} x ${c} in ${l}; show fewer nodes`);let h=a.TEXTURE_2D_ARRAY;a.bindTexture(
h,e),a.texStorage3D(h,o+1,i===1?a.R16F:a.RGBA16F,r,n,s),a.texParameteri(h,a.TEXTURE_MIN_FILTER,a.LINEAR_MIPMAP_LINEAR),a.
texParameteri(h,a.TEXTURE_MAG_FILTER,a.LINEAR),a.texParameteri(h,a.TEXTURE_WRAP_S,a.CLAMP_TO_EDGE),a.texParameteri(h,a.TEXTURE_WRAP_T,
a.CLAMP_TO_EDGE)}function et(a,{width:e,height:t,channels:r,levels:n},s,i){let o=r===1?a.RED:a.RGBA;a.pixelStorei(a.UNPACK_ALIGNMENT,
1);for(let[c,l,h]=[0,e,t];;c+=1){if(a.texSubImage3D(a.TEXTURE_2D_ARRAY,c,0,0,s,l,h,1,o,a.HALF_FLOAT,i),c===n)return;[i,l,
h]=Yr(i,l,h,r)}}var tt=class{size;poles;rays;nodes;isAlongJ;cells;lines;constructor(e,t,r){let[n,s]=t;this.poles=e,this.nodes=t,this.rays=
r,this.isAlongJ=e[0]?.component!==0,[this.lines,this.cells]=this.isAlongJ?[n,s-1]:[s,n-1];let i=e.reduce((o,c)=>o+this.depth(
c)+1,0);this.size={width:s+(this.isAlongJ?0:i),height:n+(this.isAlongJ?i:0)}}laidOut(e){if(!this.poles.length)return e;let[
t,r]=this.nodes,{width:n,height:s}=this.size,i=new Float32Array(4*n*s);for(let o=0;o<t;o+=1)i.set(e.subarray(4*r*o,4*r*(o+
1)),4*n*o);return this.poles.forEach((o,c)=>this.fill(i,o,c)),i}fastest(e){let t=0;for(let r=0;r<(this.isAlongJ?this.size.
height:this.size.width);r+=1){let n=s=>(r-s.line)*s.inward<s.near;if(!(r<this.lines&&this.poles.some(n)))for(let s=0;s<=
this.cells;s+=1){let i=this.at(r,s);t=Math.max(t,Math.abs(e[i]),Math.abs(e[i+1]))}}return t}at(e,t){return 4*(this.isAlongJ?
e*this.size.width+t:t*this.size.width+e)}depth({near:e}){return Math.min(e+3,this.lines-1)}shift(e){let t=this.poles.slice(
0,e).reduce((s,i)=>s+this.depth(i)+1,0),{inward:r,line:n}=this.poles[e];return this.lines+t-(r>0?n:n-this.depth(this.poles[e]))}ray(e,t){
let r=2*(e*(this.cells+1)+t);return[this.rays[r],this.rays[r+1]]}fill(e,t,r){let{cells:n}=this,{line:s,inward:i,component:o}=t,
[c,l]=[this.shift(r),this.still(e,t,r)];for(let h=0;h<=this.depth(t);h+=1)for(let u=0;u<=n;u+=1){let m=this.at(s+i*h,u),
p=this.at(s+i*h+c,u),[f,d]=[e[m+1-o],e[m+o]],[b,g,y]=[u,(u+1)%n,(u+n-1)%n].map(v=>this.ray(r,v));for(let v of[0,1]){let x=(g[v]-
y[v])/2;e[p+v]=h?i*d*b[v]+f*h*x:l[v]}e.copyWithin(p+2,m+2,m+4)}}still(e,{line:t,inward:r,component:n},s){let[i,o,c,l,h]=[
0,0,0,0,0];for(let m=0;m<this.cells;m+=1){let[p,f]=this.ray(s,m),d=p*p+f*f,b=e[this.at(t,m)+n]*r;[l,h]=[l+b*p,h+b*f],[i,
o,c]=[i+p*p/d,o+p*f/d,c+f*f/d]}let u=i*c-o*o;return[(c*l-o*h)/u,(i*h-o*l)/u]}get raysSize(){return[this.cells+1,Math.max(
this.poles.length,1)]}get angles(){let{cells:e}=this,[t,r]=this.raysSize,n=new Float32Array(4*t*r);return this.poles.forEach(
(s,i)=>{let o=[];for(let c=0;c<=e;c+=1){let[l,h]=this.ray(i,c),u=Math.atan2(h,l);for(;u<o[c-1];)u+=2*Math.PI;o.push(u)}o.
forEach((c,l)=>{let h=o[0]+2*Math.PI*l/e+1e-6,u=o.findLastIndex(m=>m<=h);n.set([c,Math.hypot(...this.ray(i,l)),u],4*(i*t+
l))})}),n}get uniforms(){let e=this.poles.flatMap(({line:r,inward:n,near:s},i)=>[r,n,s,this.shift(i)]),t=this.poles.flatMap(
({plane:r})=>r);for(;e.length<8;)e.push(0);for(;t.length<12;)t.push(0);return{u_poles:e,u_planes:t,u_polar:Number(this.isAlongJ)}}};var Ln=32767,[si,ai,ii,oi]=[0,1,2,3],ci=2,li=8,hi=4,mi=4,ui=64,pi=64,fi=2e4,di=1e30,kn=1e-5;function On(a,e,t){let[r,n]=t,
s=a.shape[1],[i,o]=e.drawn,c=new Float64Array(r*n*3);for(let l=0,h=0;l<r;l+=1){let u=3*((l+i+1)*s+o+1);for(let m=0;m<3*n;m+=
1)c[h++]=a.data[u+m]+e.middle[m%3]}return{data:c,shape:[r,n,3]}}function Fn(a,e,t){let[r,n]=t,s=3*a.shape[1],[i,o]=e.drawn,
c=new Int16Array(r*n*3);for(let l=0,h=0;l<r;l+=1)for(let u=0;u<n;u+=1,h+=3){let m=s*(l+i+1)+3*(u+o+1),p=b=>[0,1,2].map(g=>a.
data[m+b+g]-a.data[m-b+g]),f=V(p(3),p(s)),d=R(f)||1;for(let b=0;b<3;b+=1)c[h+b]=Math.round(f[b]/d*Ln)}for(let{component:l,
line:h,inward:u}of e.poles??[]){let[m,p]=l?[h-i,n]:[h-o,r];if(m<0||m>=(l?r:n))continue;let f=(y,v)=>3*(l?y*n+v:v*n+y),d=[
0,0,0];for(let y=0;y<p;y+=1)for(let v=0;v<3;v+=1)d[v]+=c[f(m+u,y)+v];let b=R(d)||1,g=d.map(y=>Math.round(y/b*Ln));for(let y=0;y<
p;y+=1)c.set(g,f(m,y))}return{data:c,shape:[r,n,3]}}function ie({slices:a},e){let{trace:t,times:r,lags:n}=a;if(!t?.pathlines||
!t.timed)return[e];let s=n[n.length-1]*t.timed.unit,i=r.map(c=>Math.abs(c-r[e])<s),o=c=>i[c]||i[c-1]||i[c+1];return[...r.
keys()].filter(o)}function bi({slices:a},e,t,r,n){let{trace:s,times:i}=a;if(!s?.pathlines||!s.timed)return[{from:r,to:n,
steps:[e,e],between:[0,1]}];let o=[],{unit:c}=s.timed,l=h=>t*(i[h]-i[e])/c;for(let h=e;r<n;h+=t){let u=!(h+t in i),m=u?n:
l(h+t);if(m<=r+kn*n)continue;let p=u?[0,1]:[l(h),m],f=m>=n-kn*n;o.push({from:r,to:f?n:m,steps:[h,u?h:h+t],between:p}),r=
f?n:m}return o}function rt({programs:a,floats:e},t,r){let{fullVertex:n,trace:s="",layers:i=""}=t.shaders,o=(h,...u)=>{let m=u.
filter(f=>typeof f=="string"),p=a.get(n,h,...m);if(p.error)throw new Error(`the tracer cannot be built: ${p.error}`);return p},
c=e&&"FLOWTEX_FLOATS",l=r.poles!==void 0&&"FLOWTEX_POLES";return{follow:o(s,l,r.pathlines&&"FLOWTEX_PATHLINES"),compose:r.
pathlines?null:o(s,l,"FLOWTEX_COMPOSED"),slopes:o(i,"FLOWTEX_SLOPES",c),tangents:o(i,l,c)}}var nt=class{graphics;header;trace;find;textures=new Set;frames=[];result=null;passes;flows=new Map;fastest=1;poles;constructor(e,t,r,n,s){
this.graphics=e,this.header=t,this.trace=r,this.find=n,this.poles=new tt(r.poles??[],r.nodes,n("rays")?.data??[]),this.passes=
this.slices(s)}advance(e){if(!Object.values(rt(this.graphics,this.header,this.trace)).every(r=>r?.ready??!0))return null;
let t=this.graphics.context;try{do{let{done:r,value:n}=this.passes.next();if(t.isContextLost())return null;if(r)return this.
result=null,n}while(performance.now()<e);return null}finally{this.unbind()}}dispose(){for(let e of this.textures)this.graphics.
free("Texture",e);for(let e of this.frames)this.graphics.free("Framebuffer",e);this.result&&!this.graphics.context.isContextLost()&&
this.graphics.context.deleteTexture(this.result),this.result=null,this.textures.clear(),this.frames.length=0}data(e){let t=this.
find(e);if(!t)throw new Error(`the part "${e}" of the scene is missing`);return t.data}numbers(e){let t=this.data(e);return t instanceof
Float32Array?t:new Float32Array(t).map(r=>_e[r])}texture(e,t,r,n){let s=this.graphics.context,i=this.graphics.counted(s.
createTexture());return this.textures.add(i),s.activeTexture(s.TEXTURE0),s.bindTexture(s.TEXTURE_2D,i),s.texStorage2D(s.
TEXTURE_2D,1,r,e,t),s.texParameteri(s.TEXTURE_2D,s.TEXTURE_MIN_FILTER,s.NEAREST),s.texParameteri(s.TEXTURE_2D,s.TEXTURE_MAG_FILTER,
s.NEAREST),n&&s.texSubImage2D(s.TEXTURE_2D,0,0,0,e,t,s.RGBA,s.FLOAT,n),i}frame(){let e=this.graphics.context,t=this.graphics.
counted(e.createFramebuffer());return this.frames.push(t),e.bindFramebuffer(e.FRAMEBUFFER,t),t}target(e,t){let r=this.graphics.
context,n=this.texture(e,t,r.RGBA32UI,null),s=this.frame();return r.framebufferTexture2D(r.FRAMEBUFFER,r.COLOR_ATTACHMENT0,
r.TEXTURE_2D,n,0),[n,s]}unbind(){let e=this.graphics.context;for(let t=0;t<li;t+=1)e.activeTexture(e.TEXTURE0+t),e.bindTexture(
e.TEXTURE_2D,null),e.bindTexture(e.TEXTURE_2D_ARRAY,null);e.bindFramebuffer(e.FRAMEBUFFER,null)}flow(e){let{trace:t}=this,
r=this.numbers(`flow/${e}`),n=this.data("unit"),s=r.length/n.length,i=new Float32Array(4*n.length);for(let c=0,l=0;c<n.length;c+=
1,l+=s){let h=r[l+2],u=_e[n[c]]*t.unit;i[4*c]=r[l]*h/u,i[4*c+1]=r[l+1]*h/u,i[4*c+2]=h,i[4*c+3]=t.timed?t.timed.unit:u}let o=this.
poles.laidOut(i);return t.timed&&(this.fastest=Math.max(this.fastest,this.poles.fastest(o)*t.timed.speed*t.timed.unit)),
o}wholeSpeed(e){let t=this.numbers(`flow/${e}`),r=this.data("unit").length,n=t.length/r,s=Number(this.trace.uncertain??!1),
i=new Float32Array(4*r);for(let o=0;o<r;o+=1)i[4*o]=t[(o+1)*n-1-s],i[4*o+1]=s*t[(o+1)*n-1];return i}cells(){let[e,t]=this.
trace.nodes,[r,n]=["open","nearest"].map(i=>this.find(i)?.data),s=new Float32Array(4*e*t);for(let i=0;i<e*t;i+=1){s[4*i]=
r?r[i]:1;for(let o of[0,1])s[4*i+1+o]=n?n[2*i+o]:0}return s}padded(){let e=this.data("padded"),t=new Float32Array(e.length/
3*4);for(let r=0;r<e.length/3;r+=1)for(let n=0;n<3;n+=1)t[4*r+n]=e[3*r+n];return t}flowTexture(e){let{width:t,height:r}=this.
poles.size,n=this.graphics.context,i=this.flows.get(e)??this.texture(t,r,n.RGBA32F,this.flow(e));this.flows.delete(e),this.
flows.set(e,i);for(let[o,c]of this.flows){if(this.flows.size<=mi)break;this.flows.delete(o),this.textures.delete(c),this.
graphics.free("Texture",c)}return i}partsOf({from:e,to:t}){let r=_(Math.ceil((t-e)*this.fastest/ui),1,pi),n=s=>s===r?t:e+
(t-e)*s/r;return Array.from({length:r},(s,i)=>[n(i),n(i+1)])}layerTarget(e,t){let r=this.graphics.context,{width:n,height:s}=t;
if(this.graphics.floats){let u=this.frame();return{begin:m=>(r.bindFramebuffer(r.FRAMEBUFFER,u),r.framebufferTextureLayer(
r.FRAMEBUFFER,r.COLOR_ATTACHMENT0,e,0,m),[n,s]),end:()=>{},finish:()=>{r.activeTexture(r.TEXTURE0),r.bindTexture(r.TEXTURE_2D_ARRAY,
e),t.levels&&r.generateMipmap(r.TEXTURE_2D_ARRAY)}}}let i=Math.ceil(n/2),[,o]=this.target(i,s),c=new Uint32Array(i*s*4),
l=new Uint16Array(c.buffer),h=new Uint16Array(4*n*s);return{begin:()=>(r.bindFramebuffer(r.FRAMEBUFFER,o),[i,s]),end:u=>{
r.readPixels(0,0,i,s,r.RGBA_INTEGER,r.UNSIGNED_INT,c);for(let m=0;m<s;m+=1){let p=8*i*m;h.set(l.subarray(p,p+4*n),4*n*m)}
r.activeTexture(r.TEXTURE0),r.bindTexture(r.TEXTURE_2D_ARRAY,e),et(r,t,u,h)},finish:()=>{}}}*slices(e){let{graphics:t,trace:r,
header:n}=this,s=t.context,{geometry:i,slices:o}=n,[c,l]=r.nodes,[h,u]=[i.rows.size,i.columns.size],m={width:u,height:h,
layers:o.count,channels:4,levels:i.levels},p=s.createTexture();this.result=p,s.activeTexture(s.TEXTURE0),Qe(s,p,m);let{poles:f}=this,
d=this.texture(f.size.width,f.size.height,s.RGBA32F,this.flow(e)),b=this.texture(...f.raysSize,s.RGBA32F,f.angles),g=[this.
texture(l,c,s.RGBA32F,this.cells()),this.texture(l+2,c+2,s.RGBA32F,this.padded()),this.texture(l,c,s.RGBA32F,this.wholeSpeed(
e))],y=[0,1,2,3,4].map(()=>this.target(l,c)),{lags:v,sides:x,count:w}=o,M={u_flow:0,u_cells:1,u_padded:2,u_speed:3,u_before:4,
u_last:5,u_earlier:5,u_flowNext:6,u_rays:7,...f.uniforms,u_longest:r.longest??di,u_nodes:[l,c],u_closed:[Number(r.closed[1]),
Number(r.closed[0])],u_first:[r.first[1],r.first[0]],u_texels:[u,h],u_offsetJ:r.offset.slice(0,3),u_offsetI:r.offset.slice(
3,6),u_timed:r.timed?.speed??0,u_rest:r.rest,u_pace:r.pace,u_unit:o.unit,u_cell:o.cell/o.unit,u_planar:Number(i.planar),
u_mostReach:2*v[v.length-1]},A=([C,Z],xe,he,Te)=>{s.viewport(0,0,C,Z);for(let X of[s.SCISSOR_TEST,s.DEPTH_TEST,s.BLEND,s.
CULL_FACE])s.disable(X);xe.forEach((X,te)=>{s.activeTexture(s.TEXTURE0+te),s.bindTexture(s.TEXTURE_2D,X)}),s.bindVertexArray(
null),t.programs.use(he,{...M,...Te}),s.drawArrays(s.TRIANGLES,0,3)},E=this.layerTarget(p,m),T=(C,Z,xe,he)=>{A(E.begin(C),
[d,...g,...xe],Z,he),E.end(C)},{follow:L,compose:F,slopes:I,tangents:H}=rt(t,n,r);T(0,H,[],{u_inCells:0}),w>1+x*v.length&&
T(w-1,H,[],{u_inCells:1});let W=0;for(let C=0;C<x;C+=1){let Z=C?1:-1,xe=1+C*v.length,[he,Te,X]=[y[0],y[0],y[0]];for(let[
te,Xe]of v.entries()){let[Br,Hr]=[v[te-1]??0,v[te-2]??0],zr=Xe>hi&&Hr>0?F:null,Ke=X;for(let or of bi(n,e,Z,Br,Xe)){let[Fa,
Na]=or.steps.map(cr=>this.flowTexture(cr)),Ia=zr?[[Br,Xe]]:this.partsOf(or);for(let[cr,Ca]of Ia){let Gr=y.find(Va=>![he,
Te,X,Ke].includes(Va))??y[0];s.bindFramebuffer(s.FRAMEBUFFER,Gr[1]),A([l,c],[Fa,...g,Ke[0],Te[0],Na,b],zr??L,{u_lagEarlier:Hr,
u_from:cr,u_to:Ca,u_side:Z,u_between:or.between}),Ke=Gr,!((W+=c*l)<fi)&&(s.readPixels(0,0,1,1,s.RGBA_INTEGER,s.UNSIGNED_INT,
new Uint32Array(4)),W=0,yield)}}[Te,X]=[X,Ke],te||(he=X);let ka=r.uncertain&&te===ci,Oa=te===1&&!C?ai:ka?oi:si;te&&T(xe+
te,I,[X[0],X[0]],{u_fourth:Oa,u_lag:Z*Xe})}T(xe,I,[he[0],X[0]],{u_fourth:ii,u_lag:Z*v[0]})}return E.finish(),p}};var gi={slices:[12,4],flow:[100,24]},yi=24,st=class{all=new Map;graphics;constructor(e){this.graphics=e}set(e){let{name:t,
digest:r}=e;if(r&&this.all.get(t)?.digest===r)return!1;let n=this.graphics.hold(e);return this.remove(t),this.all.set(t,
n),!0}remove(e){this.graphics.release(this.all.get(e)),this.all.delete(e)}clear(e=()=>!0){for(let t of[...this.all.keys()])
e(t)&&this.remove(t)}trim(e,t,r){let{hasSteps:n=!1,hasMarks:s=!1,memory:i=0}=t??{};if(!e||!n)return;for(let h of s?Object.
keys(we):[]){let u=[...this.all.keys()].filter(m=>m.startsWith(`${h}/`));for(let m of u.slice(0,-yi))r.includes(K(m))||this.
remove(m)}let o=e.slices.trace?"flow":"slices",c=h=>[...this.all.keys()].filter(u=>u.startsWith(h)),l=r.flatMap(h=>ie(e,
h));for(let h of c(`${o}/`).slice(0,-gi[o][+(i>0)])){let u=K(h);if(l.includes(u))continue;for(let p of[o,"extra"])this.remove(
`${p}/${u}`);let m=i?c("scalars/"):[];for(let p of m)Me(p,u,e)&&this.remove(p)}}};var at=class{controller=new AbortController;observers=new Set;timers=new Set;globalListeners=0;get isOver(){return this.
controller.signal.aborted}listen(e,t,r,n={}){(e===document||e===window)&&(this.globalListeners+=1);let{signal:s}=this.controller;
e.addEventListener(t,r,{...n,signal:s})}later(e,t){let r=setTimeout(()=>{this.timers.delete(r),e()},t);return this.timers.
add(r),r}cancel(e){e!==null&&(clearTimeout(e),this.timers.delete(e))}observe(e,t){e.observe(t),this.observers.add(e)}watch(e,t,r){
e.observe(t,r),this.observers.add(e)}stats(){let{globalListeners:e,observers:t,timers:r}=this;return{listeners:e,observers:t.
size,timers:r.size}}end(){this.controller.abort(),this.globalListeners=0;for(let e of this.observers)e.disconnect();this.
observers.clear();for(let e of this.timers)clearTimeout(e);this.timers.clear()}};function Nn(a,e,t,r=null){let{geometry:n,slices:s,constants:i}=a,o=e,c=me(a),l=2**(Math.floor(Math.log2(n.extent))-i.noiseDoublings),
h=t.eye[3],u=N(n.frame,S(t.eye,k(n.center,h))),m=In(a,e),p=m?"ramp":o.kernel,f=c&&p==="ramp"?"hann":p;return{u_eye:[...S(
u,k(t.anchor,h)),h],u_between:t.between,u_slicesSize:[n.columns.size,n.rows.size],u_deepest:n.levels,u_lags:s.lags,u_lagCount:s.
lags.length,u_sides:o.two_sided||c||m?s.sides:1,u_unit:s.unit,u_rateLayer:s.count-1,u_cell:s.cell,u_samples:it(a,e,t.still)?
2*o.samples-1:o.samples,u_spacing:o.spacing,u_grain:o.grain*t.density,u_kernel:i.kernels.indexOf(f),u_lod:o.lod,u_contrast:o.
contrast,u_strength:o.strength,u_fade:c?0:o.fade,u_seed:o.seed,u_showLevel:o.show_level,u_fixed:o.fixed_grain,...vi(a,o,
t),...xi(a,t,l),u_noiseFinest:l,u_texel:n.extent/o.resolution,u_apart:vr(a,e)*t.density,u_bySpeed:e.arrow_length==="spee\
d",u_arrowSides:s.sides,u_pieces:i.arrows.pieces,...a.paper&&r?wi(a.paper,o,r,t.density):{}}}function it(a,e,t=!1){let r=e.
motion!=="off"&&!me(a);return!a.paper&&(r||a.slices.steps>1&&!t)}function In(a,e){return!a.paper&&e.texture==="streaklet\
s"}function Pe(a,e){return Number(e.arrows)>0&&!me(a)&&!a.paper}function vr({constants:a},{arrows:e}){return a.arrows.least*
Math.max(Number(e),a.arrows.mostDense)}function ot(a,e,t){let{geometry:r,slices:n,constants:s}=a,i=e,o=Math.hypot(...S(t.
eye,r.center))-.5*r.extent,c=t.eye[3]?Math.max(o,0)/Math.hypot(...S(t.eye,t.focus)):1,l=i.lod?t.pixel*c*i.grain*t.density:
r.extent/i.resolution;return Math.floor(i.samples/2)*i.spacing*l<s.farCells*n.critical}function Cn(a,e,t,r){let n={FLOWTEX_CELLS:t,
FLOWTEX_MOVING:it(a,e,r),FLOWTEX_SPARSE:In(a,e)};return Object.entries(n).flatMap(([s,i])=>i?[s]:[])}function vi(a,e,t){
let{geometry:r,constants:n}=a,{times:s,pace:i}=a.slices,o=s.length>1,c=!o&&e.speed_in==="pixels",l=s[s.length-1]-s[0],h=l*
i/r.extent,u=o?l/(Math.round(h)||h):e.period,m=(o?t.time-s[0]:t.clock)/u%n.mostTurns,p=u*(o?i:e.speed),f=m%n.clockStep;return{
u_clock:[m-f,f],u_travel:p*(c?t.density:1),u_travelInPixels:c,u_travelBySpeed:o||e.motion==="speed",u_wave:n.wavePixels*
t.density}}function xi(a,e,t){let{noiseDoublings:r,clearDoublings:n}=a.constants,{frame:s,center:i}=a.geometry,o=N(s,S(e.
focus,i)),c=2**(r-n)-1,l=2**n,h=o.map(p=>_(Math.round(p/t/l),-c,c)*l),u=h.map(p=>p/Math.SQRT2),m=u.map(p=>Math.floor(p/l)*
l);return{u_noiseOrigin:h.map((p,f)=>p*t-e.anchor[f]),u_noiseOriginEven:h,u_noiseOriginOdd:m,u_noiseRestOdd:u.map((p,f)=>p-
m[f])}}function wi(a,e,t,r){let n=e.noise==="image"?e.tiles:1,[s,i]=t;return{u_noiseSize:a.size.map(o=>o*r),u_noiseGrain:a.
grain,u_noiseDeviation:a.deviations,u_noiseCorrected:a.corrected,u_pictureSize:[i*r*n,s*r*n],u_pictureRound:[Number(a.repeat[1]),
Number(a.repeat[0])],u_pictureGrey:t.length===2,u_tiles:n}}function xr(a,e){if(a.length<2)return[0,0,0];let t=0;for(;t<a.
length-2&&a[t+1]<=e;)t+=1;let r=(e-a[t])/(a[t+1]-a[t]);return[t,t+1,_(r,0,1)]}var Mi=.5,Ai=6,Ei=60,Si=.5,ct=class{time=0;clock=0;playing=!1;pace=1;times=[0];lastFrame=0;hasHeader=!1;setHeader(e){let{
times:t}=e.slices;(!(t.length===this.times.length&&t.every((n,s)=>n===this.times[s]))||!this.hasHeader)&&(this.time=e.time,
this.clock=e.clock),this.hasHeader=!0,this.times=t}get varies(){return this.times.length>1}get span(){return[this.times[0],
this.times[this.times.length-1]]}get moment(){return xr(this.times,this.time)}timeOf([e,t,r]){return this.times[e]+r*(this.
times[t]-this.times[e])}seek(e){this.time=_(e,...this.span)}stepFrom(e){let{times:t,time:r}=this,n=t.findIndex(o=>e>0?o>
r:o>=r),s=t.length,i=n<0?s:n;return t[(e>0?i:i-1+s)%s]}start(){this.playing=!0,this.lastFrame=0}range(e){if(this.varies)
return{first:this.span[0],last:this.span[1],now:this.time};let t=Number(e.period);return{first:0,last:t,now:this.clock%t}}advance(e,t){
let r=this.lastFrame?Math.min((e-this.lastFrame)/1e3,Si)*this.pace:0;if(this.lastFrame=e,!this.varies)return this.clock+=
r,!0;let[n,s]=this.span,i=_(Mi*(this.times.length-1),Ai,Ei),o=this.time+r*(s-n)/i,[c,l]=xr(this.times,Math.min(o,s));return t(
[c,l])?(this.time=o>s?n:o,!0):!1}};var Vn=()=>null,lt=class{};var j="",Un=5,B=a=>a.join("/"),oe=a=>a.split("/").map(Number);function Dn(a,e){let[t,r,n]=["samples","spacing","grain"].
map(i=>Number(e[i])),s=.5*t*r*n;return a.cellPixels*Math.max(1,2*s/(a.cellPixels*a.pathCells))}var ht=class{header;place;constructor(e,t){
this.header=e;let r=0,n=e.blocks.map(([s,i])=>(r+=s*i)-s*i);this.place=typeof t=="function"?t:(s,i,o)=>{let c=Un*(n[s]+i*
e.blocks[s][1]+o);return t.subarray(c,c+Un)}}blocksOf(e,[t,r,n]){let[s,i]=this.header.blocks[t];if(e===j)return[0,0,s,i];
let{tileBlocks:o}=this.header,c=[Math.min(o*(r+1),s),Math.min(o*(n+1),i)];return[o*r,o*n,...c]}children(e,[t,r,n]){let{blocks:s,
tileBlocks:i}=this.header,o=s[t-1].map(u=>Math.ceil(u/i)),[c,l]=e===j?[[0,0],o]:[[2*r,2*n],[r,n].map((u,m)=>Math.min(2*u+
2,o[m]))],h=[];for(let u=c[0];u<l[0];u+=1)for(let m=c[1];m<l[1];m+=1)h.push([t-1,u,m]);return h}finerPart([,e,t],r){let{
tileBlocks:n}=this.header,s=n/2,[,i,o]=r===j?[0,0,0]:oe(r);return[s*e-n*i,s*t-n*o,s]}choose(e){let t=new Map,{depth:r,finest:n}=this.
header,s=[j];for(let i of s){let o=i===j?[r,0,0]:oe(i),c={key:o,needed:!1,pixels:0,finer:[]},[l,h,u,m]=this.blocksOf(i,o),
p=this.header.blocks[o[0]][1],f=new Set;for(let d=l;d<u;d+=1)for(let b=h;b<m;b+=1){let g=this.place(o[0],d,b);if(!Ti(e,g))
continue;let y=_i(e,g);o[0]>n&&y>e.cellPixels?f.add(d*p+b):c.needed=!0,f.has(d*p+b)||(c.pixels=Math.max(c.pixels,y))}f.size&&
(c.finer=this.children(i,o).filter(d=>{let[b,g,y]=this.finerPart(d,j);return[...f].some(v=>{let[x,w]=[Math.floor(v/p)-b,
v%p-g];return x>=0&&x<y&&w>=0&&w<y})}).map(B)),t.set(i,c),s.push(...c.finer)}return t}};function Ti({planes:a},[e,t,r,n]){
return a.every(s=>O(s,[e,t,r])+s[3]>=-n*R(s.slice(0,3)))}function _i({eye:a,halfHeight:e,pixels:t},[r,n,s,i,o]){let c=a?
Math.max(R(S([r,n,s],a))-i,o):1;return o*.5*t/(e*c)}function Bn(a){return[...a].filter(([t,{needed:r}])=>t!==j&&r).sort(
([,t],[,r])=>r.pixels-t.pixels).map(([t])=>t)}function wr(a,e){let t=new Map,r=s=>{t.delete(s),a.get(s)?.finer.forEach(r)},
n=s=>{let{needed:i=!1,finer:o=[]}=a.get(s)??{},c=o.filter(n);return s!==j&&!i&&c.length===o.length?!0:s!==j&&!e(s)?(c.forEach(
r),!1):(t.set(s,c),!0)};return n(j),t}function mt(a,e,t){let r=s=>Math.min(s*2**e,t-1),n=Math.floor(a);return r(n)+(a-n)*
(r(n+1)-r(n))}function Hn(a,e,t){let r=2**e,n=Math.max(Math.min(Math.floor(a/r),Math.ceil((t-1)/r)-1),0);return n+(a-n*r)/
(Math.min((n+1)*r,t-1)-n*r)}var zn=1e4,Pi=20,Ri=4,Li=4,ki="The surface is shown coarse",Oi="A part of the surface is shown coarse",Fi="A time step c\
annot be shown",Ee=class{times=new Map;now;constructor(e=()=>performance.now()){this.now=e}add(e){this.times.set(e,this.
now())}has(e){return this.now()-(this.times.get(e)??-1/0)<zn}},Re=class{source;taker;running=new Map;jobs=[];failed=new Ee;constructor(e,t){
this.source=e,this.taker=t}want(e){this.jobs=e;let t=new Set(e.map(String));for(let[r,n]of this.running)t.has(r)||(this.
running.delete(r),n.abort());this.next()}stop(){this.want([]),this.failed=new Ee}next(){for(let e of this.jobs){if(this.
running.size>=(this.source()?.atOnce??Ri))return;!this.running.has(String(e))&&!this.failed.has(String(e))&&this.run(e)}}async run(e){
let{taker:t}=this,r=this.source();if(!r)return;let[n,s,i]=e,o=new AbortController,{signal:c}=o,l=h=>n?t.tiles?.has(B(n),
h)??!1:t.parts.has(h);this.running.set(String(e),o);try{let h=await r.load(n,s,c,l,i);if(!c.aborted)for(let u of h)t.setPart(
u)}catch(h){c.aborted||this.fail(e,h)}c.aborted||(this.running.delete(String(e)),this.failed.has(String(e))||(this.jobs=
this.jobs.filter(h=>String(h)!==String(e))),this.next())}fail(e,t){let[r,n]=e;this.failed.add(String(e)),setTimeout(()=>this.
next(),zn+Pi);let s=t.fault==="unreachable",i=r&&!s?B(r):void 0;this.taker.lack(Gn(r?Oi:Fi,t),i,n)}};function Gn(a,e){let{
fault:t,message:r=String(e),detail:n=""}=e;return console.warn(r,n),t==="other"?r:`${a}: ${r}`}var ut=class{tiles;wholes;marks;given;formula=null;constructor(e,t){
this.given=e,this.tiles=new Re(()=>this.source,t),this.wholes=new Re(()=>this.source,t),this.marks=new Re(()=>this.source,
t)}get source(){return this.formula??this.given}get hasSteps(){return this.source?.hasSteps??!1}get hasMarks(){return this.
source?.hasMarks??!1}setHeader(e){this.stop(),this.formula=e.formula?new lt(e,e.formula):null}follow(e){return this.formula?.
follow(e)??!1}trajectory(e){return this.formula?.trajectory(e)??null}open(){let{taker:e}=this.tiles;this.source?.open?.().
catch(t=>e.lack(Gn(ki,t)))}wantTiles(e,t){this.tiles.want(e.map(r=>[r,t]))}wantSteps(e){let t=this.wholes.jobs.flatMap(([
,n])=>n);if(e.every(n=>t.includes(n)))return;let r=[...new Set([...e,...t])].slice(0,e.length+Li);this.wholes.want(r.map(
n=>[null,[n]]))}wantMarks(e){let t=e.map(([r,n])=>[null,[n],r]);String(t)!==String(this.marks.jobs)&&this.marks.want(t)}stop(){
this.tiles.stop(),this.wholes.stop(),this.marks.stop()}};function Wn({header:a,camera:e,anchor:t,player:r,rows:n},s,i){let{geometry:o,constants:c}=a,l=e.state.focal_point,h=N(o.
frame,S(l,o.center)),u=c.anchorRange*2*e.height,m=p=>p.some(f=>Math.abs(f)>u);return{focus:l,anchor:m(S(h,t))?m(h)?h:[0,
0,0]:t,eye:e.eye,between:s[2],time:r.timeOf(s),clock:r.clock,still:!r.playing,density:i,pixel:2*e.height/Math.max(n*i,1)}}var Ni=-1e9,jn=500;function pt(a,e){if(a instanceof Float32Array&&!e.some(Boolean))return a;let t=new Float32Array(a.length);
for(let r=0;r<a.length;r+=1)t[r]=a[r]-e[r%3];return t}function $n(a,e){let t=new Float32Array(2*a.length*e.length),r=0;for(let n of e)
for(let s of a)t[r++]=s,t[r++]=n;return t}function ft({shape:a,rows:e,columns:t}){let r=(n,{before:s,size:i})=>Array.from(
{length:n},(o,c)=>(c+s+.5)/i);return $n(r(a[1],t),r(a[0],e))}function Yn({alongI:a,alongJ:e}){return $n(a,e)}function dt(a,e){
let t=a[0]?.length??0,r=new Float32Array(2*t),n=hr(e);return a.forEach((s,i)=>{for(let o=0;o<t;o+=1){let c=n(s[o]);r[2*o+
i]=Number.isFinite(c)?_(c,-jn,jn):Ni}}),r}function Xn([a,e],[t,r]){let[n,s]=[Math.min(Math.floor(t),e-2),Math.min(Math.floor(
r),a-2)],[i,o]=[t-n,r-s],c=s*e+n,[l,h]=[Math.min(i,o),Math.max(i,o)],u=c+(i>=o?1:e);return[[c,1-h],[u,h-l],[c+e+1,l]]}function Le(a,e){
return a.reduce((t,[r,n])=>t+n*e(r),0)}var Kn=180/Math.PI;var Ii=1e-4;function Ci(a){let[e,t,r]=[a-1,a-2,a-3];return[-(e*t*r)/6,a*t*r/2,-(a*e*r)/2,a*e*t/6]}function qn(a,e){let t=a*(e-1),r=_(
Math.floor(t)-1,0,e-4);return[r,Ci(t-r)]}function Mr([a,e,t,r],{data:n,shape:s},i){let[o,c]=s,[l,h]=qn((i[0]-a)/(t-a),c),
[u,m]=qn((i[1]-e)/(r-e),o),p=[0,0,0];return m.forEach((f,d)=>{h.forEach((b,g)=>{for(let y=0;y<3;y+=1)p[y]+=b*f*n[3*((u+d)*
c+l+g)+y]})}),p}function bt(a,e,t){if(a.map&&!t)return null;let[r,n,s]=a.map&&t?Mr(a.map,t,e):e,i=[Math.atan2(n,r),Math.
atan2(s,Math.hypot(r,n))];return i.every(Number.isFinite)?[i[0]*Kn,i[1]*Kn]:null}function Jn(a,e,t,r){let[n,s]=[e,t];if(a.
map&&r){let{map:p,radius:f}=a,d=Ii*(p[2]-p[0])/(Math.hypot(...t)||1),[b,g]=[-d,d].map(y=>Mr(p,r,e.map((v,x)=>v+y*t[x])));
n=Mr(p,r,e),s=g.map((y,v)=>f*(y-b[v])/(2*d))}let[i,o,c]=n,[l,h]=[Math.hypot(i,o)||1,Math.hypot(i,o,c)||1],u=(i*s[1]-o*s[0])/
l,m=(i*s[0]+o*s[1])/l;return[u,(l*s[2]-c*m)/h]}var Ar=[0,0,1,0,0,1],Vi=.86,Ui=1-1e-7;function Er(a,e,t){let r=new a.constructor(t*e.length),n=0;for(let s of e)for(let i=t*
s;i<t*s+t;i+=1)r[n++]=a[i];return r}function Zn(a){return Float32Array.from({length:Ar.length*a},(e,t)=>Ar[t%Ar.length])}
function Qn(a,e,t){let r=Er(a,t,3),n=(s,i)=>[s[3*i],s[3*i+1],s[3*i+2]];for(let s=0;s<t.length;s+=3){let[i,o,c]=[0,1,2].map(
h=>n(e,t[s+h])),l=U(V(S(o,i),S(c,i)));for(let h=s;h<s+3;h+=1){let u=n(r,h),m=R(u),p=O(l,u);Math.abs(p)<Vi*m&&r.set(l.map(
f=>f*(p<0?-m:m)),3*h)}}return r}function es(a){let e=new Float32Array(3*a.length);for(let t=0;t<e.length;t+=1)e[t]=a[3*Math.
floor(t/9)+t%3];return e}function yt(a,e,t){return[t,a+Math.min(Math.max(e,0),Ui)]}function ts(a,[e,t]){let r=Math.floor(
t),[n,s]=[t-r,e];return[1-n-s,n,s].map((o,c)=>[a[3*r+c],o])}var gt=class{shape;blocks;constructor(e,t){this.shape=[e.shape[0],
e.shape[1]],this.blocks=t.data}levels(){return new Int8Array(this.shape[0]*this.shape[1])}triangles(e){let{blocks:t}=this,
r=e.reduce((i,o,c)=>i|(o<0?0:1<<c),0),n=new Uint32Array(3*t.length),s=0;for(let i=0;i<t.length;i+=1)if(t[i]&r)for(let o=0;o<
3;o+=1)n[s++]=3*i+o;return n.slice(0,s)}};var rs=8,Di=4,Bi=10,Hi=.05,zi=.25,as=1e-6,Gi=.001;function Wi({scene:a,place:e},[t,r]){let{rows:n,columns:s,triangles:i}=a.
header.geometry;if(i){let p=[-t-r,t,r];return a.cornersAt(e).map(([f,d],b)=>[f,d+p[b]])}let[o,c]=[e[0]+t+s.before,e[1]+r+
n.before],[l,h]=[Math.floor(o),Math.floor(c)],[u,m]=[o-l,c-h];return[(1-u)*(1-m),u*(1-m),(1-u)*m,u*m].map((p,f)=>{let d=_(
l+(f&1),0,s.size-1);return[_(h+(f>>1),0,n.size-1)*s.size+d,p]})}function is(a,e=[0,0]){let{scene:t,moment:r}=a,{slices:n}=t.
header,s=Wi(a,e),[i,o,c]=r,l=s.map(([p])=>p),h=(i===o?[i]:[i,o]).map(p=>t.texels(p,l)),u=i===o?[1]:[1-c,c],m=me(t.header)?
ji(s.map((p,f)=>h[0](0,f))):s.map(()=>1);return p=>{let f=[0,0,0,0];return s.forEach(([,d],b)=>{let g=p+(p>n.lags.length?
-1:1)*n.lags.length,y=m[b]<0&&p>0?g:p;h.forEach((v,x)=>{u[x]&&v(y,b).forEach((w,M)=>{f[M]+=d*u[x]*w*(M<3?m[b]:1)})})}),f}}
function ji(a){let e=[0,0,0];return a.map(([t,r,n])=>{let s=O(e,[t,r,n])<0?-1:1;return e=P(e,[t,r,n],s),s})}function $i(a,e,t,r,n){
let[s,i]=[a(0).slice(0,3),0],o=a(t+1)[3],c=Math.min(o,e[e.length-1]),l=[];for(let h=0;h<e.length&&i<c;h+=1){let u=a(t+h+
1).slice(0,3);for(let m=1;m<=rs;m+=1){let p=m/rs,f=Math.min(i+p*(e[h]-i),c),d=(f-i)/(e[h]-i),b=s.map((g,y)=>g+d*(u[y]-g));
if(l.push(k(b,r*f*n)),f===c)break}[s,i]=[u,e[h]]}return l}function os({scene:a,place:e,position:t}){let{paper:r,geometry:n}=a.
header;if(!r)return l=>P(t,Q(n.frame,l));let{alongI:s,alongJ:i}=r,o=[ns(s,e[0]),ns(i,e[1])],c=ke(a,e);return([l,h])=>{let u=[
ss(s,o[0]+l),ss(i,o[1]+h)];return u.some(Number.isNaN)?null:P(t,S(ke(a,u),c))}}function Sr(a,e){return P(ke(a,e),a.header.
geometry.center)}function ke(a,e){let{data:t}=a.part("position"),r=a.cornersAt(e),n=[0,1,2].map(s=>Le(r,i=>t[3*i+s]));return Q(
a.header.geometry.frame,n)}function Yi(a,e){let{shape:t,triangles:r}=a.header.geometry;if(r){let o=(c,l)=>ke(a,yt(Math.floor(
e[1]),c,l));return[S(o(1,0),o(0,0)),S(o(0,1),o(0,0))]}let[n,s]=e.map((o,c)=>_(o,.5,t[1-c]-1.5)),i=(o,c)=>ke(a,[n+o,s+c]);
return[S(i(.5,0),i(-.5,0)),S(i(0,.5),i(0,-.5))]}function ns(a,e){let t=Math.min(Math.floor(e),a.length-2);return a[t]+(e-t)*(a[t+1]-a[t])}function ss(a,e){let t=a.findIndex(
r=>r>=e);return t<0||e<a[0]?NaN:t===0?0:t-1+(e-a[t-1])/(a[t]-a[t-1])}function Xi({scene:a,place:e,position:t},r,n,s){let{
geometry:i,paper:o}=a.header,c=V(...Yi(a,e)),{height:l,ray:h}=n.at(t),u=Math.max(Math.abs(O(U(c),h)),Hi),m=2*l/s;if(o){let[
g,y]=[o.alongI,o.alongJ].map((x,w)=>{let M=Math.min(Math.floor(e[w]),x.length-2);return(x[M+1]-x[M])*o.size[w]}),v=Math.
sqrt(R(c)/(g*y));return o.grain*(r.lod?Math.max(m/Math.sqrt(u),v):v)}let p=i.extent/Number(r.resolution),f=O(h,n.at(n.state.
focal_point).ray),b=m*Math.sqrt(Math.max(f,zi/u)/u)*Number(r.grain);return r.lod?r.fixed_grain?Math.max(b,p):b:p}function Ki(a,e,t){
let r=[],[n,s]=[a,t];for(let i of e){let o=R(S(i,n));if(o>=s){s>0&&r.push(P(n,S(i,n),s/(o||1)));break}r.push(i),s-=o,n=i}
return r}function Tr(a){let{scene:e,position:t}=a,{slices:r,paper:n,speed:s}=e.header,i=is(a),[o,c,l]=i(0),h=[o,c,l],u=k(
h,Gi*(n?1/n.size[0]:r.cell)/(R(h)||1)),m=R(h)>as?S(os(a)(u)??t,t):h;return k(U(m),i(2)[3]*s.typical)}function cs(a,e,t,r){
let{scene:n,position:s}=a,{slices:i,paper:o}=n.header,c=is(a),l=!me(n.header),h=c(0),u=[h[0],h[1],h[2]],m=os(a),p=[],f=e.
two_sided||!l?i.sides:1;for(let w=0;w<f&&R(u)>as;w+=1){let M=o?1:h[3]*i.unit,E=$i(c,i.lags,w*i.lags.length,w?1:-1,M).map(
m),T=E.findIndex(L=>L===null);p.push(E.slice(0,T<0?void 0:T))}let d=Number(e.samples),b=it(n.header,e,!0)?2*d-1:d,g=f===
2?Math.floor(b/2):b-1,y=Number(e.spacing)*Xi(a,e,t,r),v=w=>{let[M=[],A=[]]=p.map(E=>Ki(s,E,w));return[...M.reverse(),s,...A]};
return{path:v(Di*Math.max(g,Bi)*y),sampled:v(g*y),directed:l,velocity:Tr(a)}}var qi=8,Ji=1e-6,Zi=.001,Qi=89.99,eo=a=>a-360*Math.round(a/360);function _r([a,e]){return[[a,e],[a+1,e],[a,e+1],[a+1,e+1]]}
function vt({header:a},e){return e.map((t,r)=>_(Math.floor(t),0,a.geometry.shape[1-r]-2))}var ls=([a,e])=>[(1-a)*(1-e),a*
(1-e),(1-a)*e,a*e];function hs(a,e,[t,r],n){let{earth:s}=a.header,i=_r(e).map(d=>s&&bt(s,Sr(a,d),n));if(i.some(d=>!d||Math.
abs(d[1])>Qi))return null;let[o,c,l,h]=i.map(d=>[eo(d[0]-t),d[1]-r]),[u,m]=[c,l].map(d=>[d[0]-o[0],d[1]-o[1]]),p=Math.max(
...[...u,...m].map(Math.abs)),f=u[0]*m[1]-u[1]*m[0];return!f||[0,1].some(d=>Math.abs(o[d]-c[d]-l[d]+h[d])>Zi*p)?null:[(o[1]*
m[0]-o[0]*m[1])/f,(o[0]*u[1]-o[1]*u[0])/f]}function ms(a,e,t,r){let{earth:n,geometry:s}=a.header,i=n&&!s.triangles&&bt(n,
t,r);if(!i)return e;let o=vt(a,e);for(let c=0;c<qi;c+=1){let l=hs(a,o,i,r);if(!l)return e;let h=l.map(m=>Math.abs(m-.5)>
.5+Ji?m:0),u=vt(a,o.map((m,p)=>m+h[p]));if(String(u)===String(o))return o.map((m,p)=>m+_(l[p],0,1));o=u}return e}function us(a,e){
let{earth:t,geometry:r}=a.header;if(!t||r.triangles)return a.cornersAt(e);let n=vt(a,e),s=ls(e.map((i,o)=>i-n[o]));return _r(
n).map(([i,o],c)=>[o*r.shape[1]+i,s[c]])}function ps(a,e){let{scene:t,place:r,position:n}=a,{earth:s,geometry:i}=t.header,
o=s&&bt(s,n,e);if(!o)return null;let c=m=>Jn(s,m.position,Tr(m),e),l=vt(t,r);if(i.triangles||!hs(t,l,o,e))return c(a);let h=ls(
r.map((m,p)=>m-l[p])),u=_r(l).map(m=>c({...a,place:m,position:Sr(t,m)}));return[0,1].map(m=>u.reduce((p,f,d)=>p+h[d]*f[m],
0))}function fs(a,e,t){let{layers:r,camera:n,moment:s,anchor:i,canvas:o}=a,{graphics:c,header:l}=r[0].scene,[h]=r[0].scene.pickers,
u=G(l.geometry,n,i),m=yn(u,[e,t],[o.width,o.height]),[p,f,d]=s,b=c.numbers(()=>{r[0].scene.bodies.hide(m,i),r.forEach(({
scene:T},L)=>{c.programs.use(h,{u_matrix:m,u_between:d,u_part:L}),T.draw(p,f,i,!1)})});if(!b[3])return null;let[g,y]=new Float32Array(
b.buffer,0,2),v=r[b[2]],{geometry:x}=v.scene.header,w=x.triangles?yt(b[3]-1,g,y):to(x,g,y),M=no(v.scene,n,v.scene.cornersAt(
w),e,t),A=ms(v.scene,w,M,r[0].scene.parts.get("lonlat")),E=x.triangles?A:ro(l,v,A);return{point:{position:M,index:E,values:so(
v.scene,s,A)},layer:v,place:A}}function to({rows:a,columns:e,shape:t},r,n){let s=(i,{size:o,before:c},l)=>_(i*o-.5-c,0,l-
1);return[s(r,e,t[1]),s(n,a,t[0])]}function ro(a,{key:e},[t,r]){let{pyramid:n,geometry:s,mesh:i}=a,[o,c,l]=e,[h,u]=n?.shapes[0]??
s.shape,m=i.tileCells*(n?.tileBlocks??0),p=(f,d,b)=>mt(f+d*m,o,b);return[p(t,l,u),p(r,c,h)]}function no(a,e,t,r,n){let{data:s}=a.
part("position"),{frame:i,center:o}=a.header.geometry,c=[0,1,2].map(f=>Le(t,d=>s[3*d+f])),l=P(Q(i,c),o),[h,u]=e.ray(r,n),
m=e.axes[2],p=O(S(l,h),m)/O(u,m);return P(h,u,p)}function so(a,e,t){let{header:r,parts:n}=a,{scalars:s,geometry:i}=r,o=us(
a,t),c=i.triangles?Math.floor(t[1]):o[0][0],[l,h,u]=e,m={},p=s.choices.map((f,d)=>({...f,number:d}));for(let f of[s,...p]){
let d=a.scalarParts(l,h,f),[b,g]=d.map(v=>n.get(v)?.data);if(f.name===null||f.name in m||!b||!g)continue;let y=v=>b[v]+u*
(g[v]-b[v]);m[f.name]=f.flat?y(c):Le(o,y)}return m}function ds(a,e){var t=e[0],r=e[1],n=e[2],s=e[3],i=e[4],o=e[5],c=t*s-r*n;return c?(c=1/c,a[0]=s*c,a[1]=-r*c,a[2]=-n*c,a[3]=
t*c,a[4]=(n*o-s*i)*c,a[5]=(r*i-t*o)*c,a):null}function bs(a){return a[0]*a[3]-a[1]*a[2]}function gs(a,e,t){var r=e[0],n=e[1],
s=e[2],i=e[3],o=e[4],c=e[5],l=t[0],h=t[1],u=t[2],m=t[3],p=t[4],f=t[5];return a[0]=r*l+s*h,a[1]=n*l+i*h,a[2]=r*u+s*m,a[3]=
n*u+i*m,a[4]=r*p+s*f+o,a[5]=n*p+i*f+c,a}var io=4,oo=.3,Pr=1e-6,ys=(a,e)=>gs([0,0,0,0,0,0],a,e),vs=a=>ds([0,0,0,0,0,0],a);function xs(a,e,t,r){let[n,s]=[t/2,r/2],
i=M=>ys([n,0,0,-s,n,s],[M[0],M[1],M[4],M[5],M[12],M[13]]),o=ys(i(e),vs(i(a))),c=Math.abs(bs(o));if(!(c>oo**2&&c<io**2))return null;
let[l,h,u,m,p,f]=vs(o),d=([M,A])=>Math.abs((l*M+u*A+p)/n-1)<1+Pr&&Math.abs((h*M+m*A+f)/s-1)<1+Pr,b=[[0,0],[t,0],[0,r],[t,
r]].every(d),[g,y,v,x]=o,w=Math.abs(g-1)+Math.abs(x-1)+Math.abs(y)+Math.abs(v)<Pr;if(w)for(let M of[4,5])o[M]=Math.round(
o[M]);return{matrix:o,covers:b,shifts:w}}var co=14,lo=40,ws=1.3,Ms=5e4,ho=256;function Rr(a,e){a?.clearRect(0,0,e.width,e.height),a?.drawImage(e,0,0)}var mo=(a,e)=>a.
getContext("2d",{alpha:e}),xt=class{viewer;content;graphics;canvas;pen;back=document.createElement("canvas");backPen;last=document.
createElement("canvas");lastPen;lastCamera=null;coarse=document.createElement("canvas");coarsePen;front=document.createElement(
"canvas");frontPen=this.front.getContext("2d");frontLook="";version=1;draftVersion=0;rowsDone=0;layers=[];isRefined=!1;fixed={
strip:4,draft:4};triangles=0;isCoarse=!1;constructor(e,t){this.viewer=e,this.content=t,this.graphics=e.graphics,this.canvas=
e.canvas;let{canvas:r,back:n,last:s,coarse:i}=this,o=[r,n,s,i].map(c=>mo(c,e.isClear??!1));[this.pen,this.backPen,this.lastPen,
this.coarsePen]=o}restart(e=!1){e||(this.lastCamera=null),this.version+=1,this.rowsDone=0}refine(){(this.rowsDone>=this.
canvas.height||!this.content.isComing)&&(this.rowsDone=0),this.isRefined=!0}resize(e,t){let{canvas:r,back:n,last:s}=this;
n.width=r.width,n.height=r.height,this.backPen?.drawImage(r,0,0),r.width=s.width=e,r.height=s.height=t,n.width>1&&this.pen?.
drawImage(n,0,0,e,t),n.width=e,n.height=t}dispose(){for(let e of[this.back,this.last,this.coarse,this.front])e.width=e.height=
0}draw(e,t,r){let n=this.isMoving;if(this.draftVersion!==this.version)return this.draft(e,t,n);if(n)return!1;let s=!1;do
s=this.strip(e,t)&&!this.isRefined;while(!s&&performance.now()<r);return s}get isMoving(){return this.viewer.player.playing||
this.viewer.isHeld}get leavesOut(){return this.isCoarse&&this.isMoving}arrange(e){this.isRefined=!1,this.layers=this.content.
arrange(e)}draft(e,t,r){let{width:n,height:s}=this.canvas,i=Number(this.viewer.settings.samples),o=r?this.graphics.waiting.
size+1:1;this.arrange(t),this.warm(e,t);let c=e.price*this.factor(i),l=this.viewer.player.playing&&!this.viewer.isHeld,h=En(
c,this.fixed.draft,n*s,i,l),u=Math.max(h/o,co),m=An(c,this.fixed.draft,n*s,i,u),p=Math.max(Math.round(n*m.scale),1),f=Math.
max(Math.round(s*m.scale),1);this.draftVersion=this.version;let d=m.scale<1?this.reuse():null;if(!d?.covers){let g={width:p,
height:f,top:0,rows:f};this.timed(e,g,m.samples,()=>{this.render(e,t,g,m.samples),this.copy(this.pen,g,s,0)})}d&&this.pen&&
(this.pen.imageSmoothingEnabled=!d.shifts,this.pen.setTransform(...d.matrix),Rr(this.pen,this.last),this.pen.setTransform(
1,0,0,1,0,0)),this.isCoarse=m.scale<1||m.samples<i;let b=!this.isCoarse&&!this.content.smooth;return b&&this.complete(),
this.drawLines(t),b&&!this.isRefined}strip(e,t){let{width:r,height:n}=this.canvas,{settings:s}=this.viewer,{smooth:i}=this.
content,o=Number(s.samples);if(this.rowsDone>=n&&(this.rowsDone=0),this.rowsDone===0&&(this.arrange(t),this.isRefined))return!1;
this.warm(e,t);let c=e.price*this.factor(o),l=Math.min(n-this.rowsDone,i?ho:n),h=Math.min(Sn(lo,c,this.fixed.strip,r,o),
l),u={width:r,height:n,top:this.rowsDone,rows:h};return this.timed(e,u,o,()=>{this.render(e,t,u,o,i);let m=i?{...u,height:h,
top:0}:u;this.copy(this.backPen,m,m.height,this.rowsDone)}),this.rowsDone+=h,this.rowsDone<n?!1:(Rr(this.pen,this.back),
this.complete(),this.drawLines(t),!0)}drawLines(e){let{front:t,frontPen:r,graphics:n}=this,{camera:s,ratio:i}=this.viewer,
{scene:o}=this.content,{width:c,height:l}=this.canvas;if(!o||!s||!r)return;let{earth:h,bodies:u}=o;if(!h.lines.length&&!u.
labels.length)return;let{state:m,aspect:p}=s,f=JSON.stringify([m,p,c,l,h.lines,h.version]);if(f!==this.frontLook){let{anchor:d}=this.
viewer.view(e,i),{canvas:b}=n;b.width<c&&(b.width=c),b.height<l&&(b.height=l),t.width=c,t.height=l,h.drawLines({camera:s,
anchor:d,width:c,height:l,ratio:i},()=>{let g=b.height-l;r.drawImage(b,0,g,c,l,0,0,c,l)}),u.drawLabels(r,{camera:s,anchor:d,
width:c,height:l,ratio:i}),this.frontLook=f}this.pen?.drawImage(t,0,0)}complete(){let{camera:e,player:t}=this.viewer;this.
rowsDone=this.canvas.height,this.isCoarse=!1,this.draftVersion=this.version,Rr(this.lastPen,this.canvas),e&&!t.playing&&
(this.lastCamera=new fe(e.state,e.limits,e.flat,e.aspect))}reuse(){let{lastCamera:e}=this,{camera:t}=this.viewer,{scene:r}=this.
content;if(!r?.header.geometry.planar||!t||!e||!t.state.parallel||!e.state.parallel)return null;let{geometry:n}=r.header,
s=S(t.state.focal_point,n.center),i=N(n.frame,s),[o,c]=[e,t].map(l=>G(n,l,i));return xs(o,c,this.canvas.width,this.canvas.
height)}factor(e){let{settings:t,player:r}=this.viewer;return t.motion!=="off"||r.varies&&r.playing?Tn(e):1}timed(e,t,r,n){
let s=performance.now();n();let i=performance.now()-s,o=t.width*t.rows,c=this.factor(r),l=t.rows<t.height?this.fixed.strip:
this.fixed.draft;e.price=_n(e.price,i,l,o,r,c)}warm(e,t){let r=this.layers.reduce((u,m)=>u+m.triangles,0),n=(r+Ms)/(this.
triangles+Ms);if(e.warm&&n<ws&&n>1/ws)return;let{width:s,height:i}=this.canvas,o={width:s,height:i,top:0,rows:1},[c,l]=[
s,i].map(u=>Math.max(Math.round(u*br),1));e.warm||this.render(e,t,o,1),this.triangles=r;let h=[o,{width:c,height:l,top:0,
rows:l}].map(u=>{let m=performance.now();return this.render(e,t,u,1),_(performance.now()-m,.5,500)});this.fixed={strip:h[0],
draft:h[1]},e.warm=!0}render(e,t,r,n,s=!1){let{graphics:i,viewer:o}=this,{camera:c}=o,{scene:l}=this.content;if(!c||!l)return;
let h=i.context,{width:u,height:m,top:p,rows:f}=r,d=o.view(t,o.ratio*m/this.canvas.height),{canvas:b}=i;b.width<u&&(b.width=
u),b.height<m&&(b.height=m);let g=m-p-f;s?i.bindSmooth(u,f):h.bindFramebuffer(h.FRAMEBUFFER,null),h.viewport(0,s?-g:0,u,
m),h.enable(h.SCISSOR_TEST),h.scissor(0,s?0:g,u,f),h.enable(h.DEPTH_TEST),h.depthFunc(h.LESS),h.disable(h.BLEND),h.disable(
h.CULL_FACE);let[y,v,x]=l.header.background??[1,1,1];h.clearColor(y,v,x,o.isClear?0:1),h.clear(h.COLOR_BUFFER_BIT|h.DEPTH_BUFFER_BIT);
let w=n!==o.settings.samples||m!==this.canvas.height,M={camera:c,anchor:d.anchor,width:u,height:m,ratio:o.ratio};l.earth.
drawGround(M);let{bodies:A}=l;A.draw(M,"opaque"),A.seeThrough(()=>{for(let E of this.layers)i.programs.use(e,this.values(
E,l,c,d,n,w)),E.draw(t[0],t[1],d.anchor,!0)}),this.drawArrows(t,d,r,E=>this.values(E,l,c,d,n,w)),A.draw(M,"clear"),l.marks.
draw({...M,ratio:d.density},o.settings,t),s&&i.copySmooth(u,f),h.readPixels(0,0,1,1,h.RGBA,h.UNSIGNED_BYTE,new Uint8Array(
4))}drawArrows(e,t,{width:r,height:n},s){let{camera:i,settings:o}=this.viewer,{scene:c}=this.content;if(!c||!i||!Pe(c.header,
o))return;let l={...i.sight(n/t.density),planes:i.planes};for(let[h,u]of c.arrows.share(l,o,this.layers)){let{arrows:m,header:p}=h,
f=m.program(o,ot(p,o,t));if(!f||!u.length)continue;h.bindTextures(e[0],e[1]);let d=h.scalarParts(e[0],e[1]);m.draw(f,u,d,
t.anchor,{...s(h),u_picture:[r,n]})}}values({header:e,parts:t},{bodies:r},n,s,i,o){let{settings:c}=this.viewer,{columns:l,
rows:h}=e.geometry,u=t.get("noise")?.shape??null,m=e.scalars.name!==null&&Pe(e,c)&&c.arrow_color==="scalars";return{...Nn(
e,{...c,samples:i},s,u),...o?Pn(c,i,s.density):{},u_matrix:G(e.geometry,n,s.anchor),u_mapped:e.scalars.name!==null&&!m,u_plain:m,
u_flat:!!e.scalars.flat,u_padding:[l.before,h.before],u_colour:e.colour,u_lit:e.lighting,u_ground:e.background??[1,1,1],
u_opacity:r.areBehind?1:e.opacity,u_toEye:N(e.geometry.frame,k(n.axes[2],-1))}}copy(e,t,r,n){if(!e)return;let{width:s,height:i,
top:o,rows:c}=t,{width:l}=this.canvas,{canvas:h}=this.graphics,u=h.height-i+o;if(e.imageSmoothingEnabled=s!==l||i!==r,e.
imageSmoothingEnabled){let{coarse:m,coarsePen:p}=this;m.width=s,m.height=c,p?.drawImage(h,0,u,s,c,0,0,s,c),[h,u]=[m,0]}e.
clearRect(0,n,l,c*r/i),e.drawImage(h,0,u,s,c,0,n,l,c*r/i)}};var Et=4,St=class{surface;limits;sums;whole=[[]];last=null;constructor(e,t){this.surface=e,this.limits=t;let r=0;this.sums=
Float64Array.from({length:e.corners.length/Et},(n,s)=>r+=this.area(Lr(s)))}seen(e,t){return(!this.last||!this.covers(this.
last.wanted,[e,t]))&&(this.last={wanted:[e,t],seeds:this.make([e,t])}),this.last.seeds}position(e,t){let{nodes:r,corners:n}=this.
surface;return Oe(r,n.subarray(Et*e,Et*(e+1)),t,3)}point(e){let{frame:t,center:r}=this.surface.geometry;return P(Q(t,e),
r)}covers([e,t],[r,n]){let{closer:s}=this.limits;return this.cornersOf(r).every(i=>s*t*At(e,i)<=n*At(r,i)&&this.sees(e,i,
0))}cornersOf({planes:e}){let{center:t,extent:r}=this.surface.geometry,n=c=>e[c].slice(0,3),s=V(n(0),n(2)),i=.5*r*R(s);return[
0,1].flatMap(c=>[2,3].flatMap(l=>[-1,1].map(h=>[c,l,h]))).map(([c,l,h])=>{let[u,m]=[n(c),n(l)],p=P(k(V(m,s),-e[c][3]),V(
s,u),-e[l][3]),f=V(u,m);return k(P(p,f,O(s,t)+h*i),1/O(f,s))})}sees(e,t,r){let n=r+this.limits.around*e.pixels*At(e,t);return e.
planes.every(s=>O(s,t)+s[3]>=-n*R(s))}make(e){let[t,r]=e,{limits:n,sums:s,whole:i}=this,{extent:o,center:c}=this.surface.
geometry,l=s[s.length-1]??0,h=t.eye?Math.max(R(S(c,t.eye))-.5*o,0):1,u=n.closer*r*kr(t,h),m=o,p=i[0],f=null;for(let d=0;d<
n.mostOctaves;d+=1){let b=n.candidateArea*m**2;if(l<=n.mostCandidates*b)i[d+1]??=this.grown(p,this.spread(d,b),m),p=i[d+
1];else{f??=Array.from(s,(y,v)=>Lr(v)),f=this.divided(f.filter(y=>this.isNeeded(y,e,m)),b);let g=f.flatMap(y=>{let v=ce(
y.key+d);return Mt(v)*b<this.area(y)?[this.candidate(y,v)]:[]});if(p=this.grown(p,g,m),!f.length)break}if(m<=u)break;m*=
n.octave}return p.filter(d=>{let b=this.point(d.position);return d.radius>=n.closer*r*At(t,b)&&this.sees(t,b,0)})}spread(e,t){
let{sums:r}=this,n=ce(e+wt),s=0;return Array.from({length:Math.floor((r[r.length-1]??0)/t)},(i,o)=>{let c=ce(n+o),l=(o+Mt(
c))*t;for(;s<r.length-1&&r[s]<=l;)s+=1;return this.candidate(Lr(s),c)})}candidate({cell:e,low:t,size:r},n){let s=ce(n+wt),
i=ce(s+wt),o=[t[0]+r[0]*Mt(s),t[1]+r[1]*Mt(i)];return{cell:e,place:o,position:this.position(e,o),radius:1/0}}grown(e,t,r){
let n=r/this.limits.octave,s=new Tt(n);for(let l of e)s.add(l.position);for(let l of t)l.radius=s.distance(l.position);let i=t.
filter(({radius:l})=>l>=r).sort((l,h)=>h.radius-l.radius),o=new Tt(n),c=i.filter(l=>(l.radius=Math.min(l.radius,o.distance(
l.position)),l.radius<r?!1:(o.add(l.position),!0)));return[...e,...c]}isNeeded(e,[t,r],n){let{octave:s,closer:i,aroundRadii:o}=this.
limits,{cell:c,low:l,size:h}=e,u=this.point(this.position(c,[l[0]+.5*h[0],l[1]+.5*h[1]])),[m,p]=this.sides(e),f=.5*(R(m)+
R(p)),d=Math.max(Ss(t,u)-f,0);return!(n<s*i*r*kr(t,d))&&this.sees(t,u,f+o*n)}divided(e,t){let r=e.filter(i=>this.area(i)>
t);if(!r.length)return e;let n=r.map(i=>{let[o,c]=this.sides(i),l=R(c)>R(o)?1:0,h=[...i.size];h[l]*=.5;let u=[...i.low];
return u[l]+=h[l],[{...i,size:h,key:ce(i.key+wt)},{...i,size:h,low:u,key:ce(i.key+uo)}]}),s=e.filter(i=>this.area(i)<=t);
return this.divided([...s,...n.map(([i])=>i),...n.map(([,i])=>i)],t)}sides({cell:e,low:t,size:r}){let n=(s,i)=>this.position(
e,[t[0]+r[0]*s,t[1]+r[1]*i]);return[S(n(1,.5),n(0,.5)),S(n(.5,1),n(.5,0))]}area(e){return R(V(...this.sides(e)))}};function Oe(a,e,[
t,r],n){let s=[(1-r)*(1-t),(1-r)*t,r*(1-t),r*t],i=new Array(n).fill(0);for(let o=0;o<Et;o+=1)for(let c=0;c<n;c+=1)i[c]+=
s[o]*a[n*e[o]+c];return i}var Tt=class{most;cubes=new Map;constructor(e){this.most=e}cube(e){return e.map(t=>Math.floor(
t/this.most))}add(e){let t=Es(...this.cube(e)),r=this.cubes.get(t);r?r.push(e):this.cubes.set(t,[e])}distance(e){let[t,r,
n]=this.cube(e),s=this.most;for(let i=0;i<27;i+=1){let o=Es(t+i%3-1,r+Math.floor(i/3)%3-1,n+Math.floor(i/9)-1);for(let c of this.
cubes.get(o)??[])s=Math.min(s,R(S(e,c)))}return s}},wt=2654435769,uo=2246822507,po=[739982445,695872825],As=15;function Es(a,e,t){
return Math.imul(a,2376512323)^Math.imul(e,3625334849)^Math.imul(t,3407524639)}function ce(a){let e=a>>>0;for(let t of po)
e=Math.imul(e^e>>>As,t)>>>0;return(e^e>>>As)>>>0}var Mt=a=>a/2**32;function Lr(a){return{cell:a,low:[0,0],size:[1,1],key:ce(
a)}}var Ss=({eye:a},e)=>a?R(S(e,a)):1,kr=({halfHeight:a,pixels:e},t)=>2*a/e*t,At=(a,e)=>kr(a,Ss(a,e));var Ps=[[0,3],[1,2],[2,3],[4,2],[5,3],[6,1]],Ts=4,fo=Ps.reduce((a,[,e])=>a+e,0),bo=(a,e)=>a.length===e.length&&a.every((t,r)=>t===
e[r]),_s=({tile:a})=>a?.[0]??1/0,_t=class{graphics;header;parts;seeds=null;array=null;buffer=null;known=null;last=null;drawn=null;constructor(e,t,r){
this.graphics=e,this.header=t,this.parts=r}program(e,t){let{shaders:r,geometry:n}=this.header;if(!Pe(this.header,e))return null;
let s=t&&!n.triangles?["FLOWTEX_CELLS"]:[];return this.graphics.programs.get(r.arrowVertex,r.arrowFragment,...s)}share(e,t,r){
let{header:n,last:s}=this;this.seeds??=new St(this.surface,n.constants.arrows);let i=this.seeds.seen(e,vr(n,t));if(s?.seeds===
i&&bo(r,s.layers))return s.shared;let{corners:o}=this.surface,c=i.map(({cell:u,place:m,radius:p})=>{let f=o.subarray(4*u,
4*u+4);return{corners:f,place:m,radius:p,cell:n.geometry.triangles?u:f[0]}}),l=new Map(r.map(u=>[u,[]])),h=[...r].sort((u,m)=>_s(
u)-_s(m));for(let u of c)for(let m of h){let p=m.tile?this.inTile(u,m,m.tile):u;if(p){l.get(m)?.push(p);break}}return this.
last={seeds:i,layers:r,shared:l},l}draw(e,t,r,n,s){let{graphics:i}=this,o=i.context;this.array??=this.make(),o.bindVertexArray(
this.array);let{name:c,low:l,high:h,log:u}=this.header.scalars,m=r.map(f=>this.parts.get(f)?.digest),p=JSON.stringify([n,
r,m,c,l,h,u]);(this.drawn?.placed!==t||this.drawn.key!==p)&&(o.bindBuffer(o.ARRAY_BUFFER,this.buffer),o.bufferData(o.ARRAY_BUFFER,
this.numbers(t,r,n),o.DYNAMIC_DRAW),this.drawn={placed:t,key:p}),i.programs.use(e,s),o.enable(o.BLEND),o.blendFuncSeparate(
o.SRC_ALPHA,o.ONE_MINUS_SRC_ALPHA,o.ZERO,o.ONE),o.depthMask(!1),o.drawArraysInstanced(o.TRIANGLE_STRIP,0,2*(this.header.
constants.arrows.pieces+1),t.length),o.depthMask(!0),o.disable(o.BLEND),o.bindVertexArray(null)}forget(){this.known=this.
seeds=this.last=this.drawn=null}dispose(){this.graphics.free("Buffer",this.buffer),this.graphics.free("VertexArray",this.
array),this.array=this.buffer=null,this.forget()}inTile({corners:e,place:t,radius:r},n,[s,i,o]){let{geometry:c,pyramid:l,
mesh:h}=this.header;if(!l||c.triangles)return null;let u=h.tileCells*l.tileBlocks,[m,p]=n.header.geometry.shape,f=c.shape[1],
d=(v,x,w,M)=>{let A=l.shapes[0][x],E=Hn(mt(v,l.depth,A),s,A)-w*u,T=Math.min(Math.max(Math.floor(E),0),M-1);return E<0||E>
M?null:[T,E-T]},b=d(e[0]%f+t[0],1,o,p-1),g=d(Math.floor(e[0]/f)+t[1],0,i,m-1);if(!b||!g||n.parts.get("cells")?.data[g[0]*
(p-1)+b[0]]===0)return null;let y=g[0]*p+b[0];return{corners:[y,y+1,y+p,y+p+1],place:[b[1],g[1]],radius:r,cell:y}}make(){
let e=this.graphics.context,t=this.graphics.counted(e.createVertexArray());this.buffer=this.graphics.counted(e.createBuffer()),
e.bindVertexArray(t),e.bindBuffer(e.ARRAY_BUFFER,this.buffer);let r=0;for(let[n,s]of Ps)e.enableVertexAttribArray(n),e.vertexAttribPointer(
n,s,e.FLOAT,!1,fo*Ts,r),e.vertexAttribDivisor(n,1),r+=s*Ts;return t}numbers(e,t,r){let{geometry:n,scalars:s}=this.header,
i=t.map(h=>this.parts.get(h)?.data??new Float32Array),o=dt(i,s),c=this.nodes,l=n.triangles?null:ft(n);return Float32Array.
from(e.flatMap(({corners:h,place:u,radius:m,cell:p})=>{let[f,d]=u,[b,g,y,v]=Array.from(h,w=>[...c.subarray(3*w,3*w+3)]),
x=V(S(P(g,v),P(b,y)),S(P(y,v),P(b,g)));return[...S(Oe(c,h,u,3),r),...l?Oe(l,h,u,2):[f*(1-d),d],...U(x),...s.flat?o.subarray(
2*p,2*p+2):Oe(o,h,u,2),...Array.from(h).slice(0,3),m]}))}get nodes(){return this.parts.get("position")?.data??new Float32Array}get surface(){
return this.known??={geometry:this.header.geometry,nodes:this.nodes,corners:this.corners()}}corners(){let{geometry:e}=this.
header,[t,r]=e.shape,n=[];if(e.triangles){let i=this.parts.get("triangles")?.data??[];for(let o=0;o<i.length;o+=3)n.push(
i[o],i[o+1],i[o+2],i[o+2]);return Uint32Array.from(n)}let s=this.parts.get("cells")?.data;for(let i=0;i<(t-1)*(r-1);i+=1){
if(s&&!s[i])continue;let o=i+Math.floor(i/(r-1));n.push(o,o+1,o+r,o+r+1)}return Uint32Array.from(n)}};var Fe=["bodyPoints","bodyNormals","bodyColours","bodyFaces","bodyPieces"],Rs=8,[go,yo]=[24,8],Pt=[1,2],vo=.2;function Ne(a,e,t){
let r=a.constructor,n=new r(t*e.length);for(let s=0;s<e.length;s+=1)for(let i=0;i<t;i+=1)n[t*s+i]=a[t*e[s]+i];return n}function xo({
geometry:a,bodies:e},t){let[r,n,s]=t.axes,i=(e?.lights??[]).slice(0,Rs),o=i.map(({way:l,turns:h})=>{let u=P(P(k(r,l[0]),
n,l[1]),s,-l[2]);return N(a.frame,h?u:l)}),c=l=>Float32Array.from({length:3*Rs},(h,u)=>l.flat()[u]??0);return{u_lightWays:c(
o),u_lightColours:c(i.map(({color:l})=>l))}}var Rt=class{graphics;header;parts;drawn=null;constructor(e,t,r){this.graphics=
e,this.header=t,this.parts=r}get labels(){return this.header.bodies?.labels??[]}get runs(){let{bodies:e}=this.header;return e&&
Fe.every(t=>this.parts.has(t))?e.runs:[]}get areBehind(){return this.runs.length>0&&this.header.opacity<1}get programs(){
let{programs:e}=this.graphics,{bodyVertex:t,bodyFragment:r,lineVertex:n,lineFragment:s}=this.header.shaders;return[e.get(
t,r),e.get(n,s,"FLOWTEX_BODY"),e.get(t,r,"FLOWTEX_HIDING")]}get isReady(){return!this.runs.length||this.programs.every(({
ready:e})=>e)}dispose(){let{drawn:e,graphics:t}=this;if(e){for(let r of e.buffers)t.free("Buffer",r);t.free("VertexArray",
e.faces),t.free("VertexArray",e.pieces),this.drawn=null}}seeThrough(e){if(!this.runs.length)return e();let t=this.graphics.
context;t.enable(t.POLYGON_OFFSET_FILL),t.polygonOffset(Pt[0],Pt[0]),this.areBehind&&(t.enable(t.BLEND),t.blendColor(0,0,
0,this.header.opacity),t.blendFuncSeparate(t.CONSTANT_ALPHA,t.ONE_MINUS_CONSTANT_ALPHA,t.ZERO,t.ONE)),e(),t.disable(t.BLEND),
t.disable(t.POLYGON_OFFSET_FILL)}draw({camera:e,anchor:t,width:r,height:n,ratio:s},i){let o=i==="clear",c=this.runs.filter(
({clear:A})=>A===o);if(!c.length)return;let{header:l,graphics:h}=this,{geometry:u}=l,m=h.context,[p,f]=this.programs,d=this.
drawn??=this.make(),b=G(u,e,t),[g,y,v,x]=e.eye,w=N(u.frame,S([g,y,v],k(u.center,x)));o&&(m.enable(m.BLEND),m.blendFuncSeparate(
m.SRC_ALPHA,m.ONE_MINUS_SRC_ALPHA,m.ZERO,m.ONE),m.depthMask(!1)),h.programs.use(p,{u_matrix:b,u_anchor:t,u_eye:[...S(w,k(
t,x)),x],...xo(l,e)}),m.bindVertexArray(d.faces),m.enable(m.POLYGON_OFFSET_FILL),m.polygonOffset(Pt[1],Pt[1]);for(let{faces:[
A,E],ambient:T,diffuse:L}of c)E&&(h.programs.use(p,{u_ambient:T,u_diffuse:L}),m.drawElements(m.TRIANGLES,3*E,m.UNSIGNED_INT,
12*A));m.disable(m.POLYGON_OFFSET_FILL);let M={u_matrix:b,u_anchor:t,u_picture:[r,n],u_horizon:[0,0,0,1]};h.programs.use(
f,M),m.bindVertexArray(d.pieces);for(let{pieces:[A,E],width:T}of c)if(E){h.programs.use(f,{u_width:T*s});for(let[L,F,I,H,
W]of[[d.ends,3,m.FLOAT,go,0],[d.colours,4,m.UNSIGNED_BYTE,yo,2]]){m.bindBuffer(m.ARRAY_BUFFER,L);for(let C of[0,1])m.vertexAttribPointer(
W+C,F,I,F===4,H,H*(A+C/2))}m.drawArraysInstanced(m.TRIANGLE_STRIP,0,4,E)}m.bindVertexArray(null),m.depthMask(!0),m.disable(
m.BLEND)}hide(e,t){let{runs:r,drawn:n,graphics:s}=this;if(!r.length||!n)return;let i=s.context;s.programs.use(this.programs[2],
{u_matrix:e,u_anchor:t}),i.bindVertexArray(n.faces);for(let{faces:[o,c],clear:l}of r)l||i.drawElements(i.TRIANGLES,3*c,i.
UNSIGNED_INT,12*o);i.bindVertexArray(null)}drawLabels(e,{camera:t,anchor:r,width:n,height:s,ratio:i}){let{geometry:o}=this.
header,c=G(o,t,r);for(let{text:l,position:h,size:u,color:m,plate:p}of this.labels){let f=S(N(o.frame,S(h,o.center)),r),[
d,b,,g]=[0,1,2,3].map(E=>c[E]*f[0]+c[4+E]*f[1]+c[8+E]*f[2]+c[12+E]);if(g<=0)continue;let[y,v]=[(.5+.5*d/g)*n,(.5-.5*b/g)*
s],x=u*i,w=vo*x;e.font=`600 ${x}px system-ui, sans-serif`,e.textBaseline="middle";let[M,A]=[e.measureText(l).width+2*w,x+
2*w];e.fillStyle=Ls(p),e.beginPath(),e.roundRect(y,v-A,M,A,w),e.fill(),e.fillStyle=Ls(m),e.fillText(l,y+w,v-.5*A)}}make(){
let{graphics:e,parts:t}=this,r=e.context,[n,s,i,o,c]=Fe.map(g=>t.get(g)?.data??[]),l=()=>{let g=e.counted(r.createVertexArray());
return r.bindVertexArray(g),g},h=(g,y=r.ARRAY_BUFFER)=>{let v=e.counted(r.createBuffer());return r.bindBuffer(y,v),r.bufferData(
y,g,r.STATIC_DRAW),v},u=l(),p=[[n,3,r.FLOAT],[s,3,r.BYTE],[i,4,r.UNSIGNED_BYTE]].map(([g,y,v],x)=>{let w=h(g);return r.enableVertexAttribArray(
x),r.vertexAttribPointer(x,y,v,v!==r.FLOAT,0,0),w});p.push(h(o,r.ELEMENT_ARRAY_BUFFER));let f=l(),d=h(Ne(n,c,3)),b=h(Ne(
i,c,4));for(let g=0;g<4;g+=1)r.enableVertexAttribArray(g),r.vertexAttribDivisor(g,1);return r.bindVertexArray(null),{faces:u,
pieces:f,ends:d,colours:b,buffers:[...p,d,b]}}};function Ls([a,e,t,r=1]){return`rgb(${[a,e,t].map(n=>Math.round(255*n)).
join(" ")} / ${r})`}function ks(a,{low:e,size:t}){let r=[],n=[0,0,0];for(let s=0;s<a.length;s+=4){a[s+3]&&r.push([]);let i=n.map((o,c)=>(n[c]=
n[c]+a[s+c]&65535,e[c]+n[c]/65535*t[c]));r[r.length-1].push(i)}return r}function Os(a,e){return e?a.flatMap(t=>{let r=0,
n=t.filter((s,i)=>{let o=r;return i&&(r+=Math.hypot(...s.map((l,h)=>l-t[i-1][h]))),Math.floor(r/e)>Math.floor(o/e)||i===
0||i===t.length-1});return r<e?[]:[n]}):a}function Fs(a,e){let t=a.reduce((s,i)=>s+i.length+1,0),r=new Float32Array(3*t).
fill(1e30),n=0;for(let s of a){n+=3;for(let i of s)for(let o=0;o<3;o+=1)r[n++]=i[o]-e[o]}return r}function Ns(a){let e=[],
t=a.length/3-1;for(let r=0;r<t;r+=256){let n=Math.min(256,t-r),[s,i]=[[1/0,1/0,1/0],[-1/0,-1/0,-1/0]];for(let l=3*r;l<3*
(r+n+1);l+=1)a[l]!==Math.fround(1e30)&&(s[l%3]=Math.min(s[l%3],a[l]),i[l%3]=Math.max(i[l%3],a[l]));let o=s.map((l,h)=>(l+
i[h])/2),c=Math.hypot(...s.map((l,h)=>(i[h]-l)/2));e.push({first:r,count:n,middle:o,radius:c})}return e}function Is(a,e){
let t=[];for(let{first:r,count:n,middle:[s,i,o],radius:c}of a){let l=([u,m,p,f])=>u*s+m*i+p*o+f<-c*Math.hypot(u,m,p);if(e.
some(l))continue;let h=t[t.length-1];h&&h[0]+h[1]===r?h[1]+=n:t.push([r,n])}return t}var Cs=12,Vs=2;var Lt=class{version=0;graphics;header;parts;drawn=new Map;constructor(e,t,r){this.graphics=e,this.header=t,this.parts=r}forget(e){
this.version+=1,this.drop(e==="position"?"land":e)}dispose(){for(let e of[...this.drawn.keys()])this.drop(e)}drop(e){let t=this.
drawn.get(e);if(t){for(let r of t.buffers)this.graphics.free("Buffer",r);this.graphics.free("VertexArray",t.array),this.
drawn.delete(e)}}get lines(){let{earth:e}=this.header;return e?qr.filter(t=>e[t]&&this.parts.has(t)):[]}drawLines(e,t){let{
header:r,graphics:n}=this,{earth:s,shaders:i}=r,o=n.programs.get(i.lineVertex,i.lineFragment);if(!s||!o.ready)return;let c=n.
context,{camera:l,anchor:h,width:u,height:m,ratio:p}=e;c.bindFramebuffer(c.FRAMEBUFFER,null),c.viewport(0,0,u,m),c.enable(
c.SCISSOR_TEST),c.scissor(0,0,u,m),c.disable(c.DEPTH_TEST),c.enable(c.BLEND),c.blendEquation(c.MAX),c.clearColor(0,0,0,0);
let f=this.horizon(l),b=[...l.planes,...f?[f]:[]].map(w=>this.localPlane(w,h)),g=2*l.height*p/m,y=_(Math.sqrt(m/p/s.usualHeight),
...s.widthRange),v=s.spacingPixels*g,x=s.spacings.find(w=>w<=v)??0;for(let{option:w,color:M,opacity:A,width:E}of s.strokes){
if(!this.lines.includes(w))continue;c.clear(c.COLOR_BUFFER_BIT);let T=this.take(w,h,()=>this.linesOf(w,h,x),x);n.programs.
use(o,{u_matrix:G(r.geometry,l,h),u_picture:[u,m],u_width:E*y*p,u_lineColour:[...M,A],u_horizon:f?b[b.length-1]:[0,0,0,1]}),
c.bindVertexArray(T.array),c.bindBuffer(c.ARRAY_BUFFER,T.buffers[0]);for(let[L,F]of Is(T.groups,b)){for(let I=0;I<Vs;I+=
1)c.vertexAttribPointer(I,3,c.FLOAT,!1,Cs,(L+I)*Cs);c.drawArraysInstanced(c.TRIANGLE_STRIP,0,4,F)}t()}c.bindVertexArray(
null),c.blendEquation(c.FUNC_ADD),c.disable(c.BLEND)}get isReady(){let{lineVertex:e,lineFragment:t}=this.header.shaders;
return!this.lines.length||this.graphics.programs.get(e,t).ready}drawGround({camera:e,anchor:t}){let{header:r,graphics:n}=this,
{earth:s,shaders:i,geometry:o}=r;if(!s?.land)return;let c=s.map===null;if(!(c?s.below:this.parts.has("land")))return;let l=n.
context,h=c?["FLOWTEX_GLOBE"]:[],u=n.programs.get(i.groundVertex,i.groundFragment,...h);if(u.ready){if(n.programs.use(u,
{u_matrix:G(o,e,t),u_colour:s.land,u_ground:r.background??[1,1,1],u_lit:r.lighting,u_toEye:N(o.frame,k(e.axes[2],-1)),...c?
this.disc(e,s.radius,t):{}}),c){let m=this.take("disc",t,()=>this.emptyArray());l.bindVertexArray(m.array),l.drawArrays(
l.TRIANGLE_STRIP,0,4)}else{let m=this.take("land",t,()=>this.landOf(t));l.bindVertexArray(m.array),l.depthMask(!1),l.drawElements(
l.TRIANGLES,m.count,l.UNSIGNED_INT,0),l.depthMask(!0)}l.bindVertexArray(null)}}horizon(e){let{earth:t}=this.header;if(!t||
t.map)return null;let{radius:r}=t,[n,s,i,o]=e.eye,c=o*Math.hypot(n,s,i);return[...U([n,s,i]),c?-(r**2)/c:0]}localPlane(e,t){
let{frame:r,center:n}=this.header.geometry,s=e.slice(0,3),i=N(r,s);return[...i,O(i,t)+O(s,n)+e[3]]}disc(e,t,r){let{frame:n,
center:s}=this.header.geometry,[i,o,c,l]=this.horizon(e)??[0,0,1,0],h=[i,o,c],u=Math.sqrt(Math.max(t**2-l**2,0)),m=U(V(e.
axes[1],h)),p=V(h,m),f=P(k(h,-l),s,-1);return{u_middle:S(N(n,f),r),u_aside:k(N(n,m),u),u_upward:k(N(n,p),u),u_away:e.state.
parallel?0:R(e.state.position)/t}}take(e,t,r,n=0){let s=this.drawn.get(e);if(s&&String([s.anchor,s.spacing])===String([t,
n]))return s;this.drop(e);let i={...r(),anchor:t,spacing:n};return this.drawn.set(e,i),i}emptyArray(){let{graphics:e}=this;
return{array:e.counted(e.context.createVertexArray()),buffers:[],anchor:[0,0,0],spacing:0,count:0,groups:[]}}buffer(e,t){
let{graphics:r}=this,n=r.context,s=r.counted(n.createBuffer());return n.bindBuffer(e,s),n.bufferData(e,t,n.STATIC_DRAW),
s}linesOf(e,t,r){let n=this.graphics.context,{earth:s}=this.header,i=this.parts.get(e)?.data??[],o=s?ks(i,s):[],c=Fs(Os(
o,r),t),l={...this.emptyArray(),groups:Ns(c)};n.bindVertexArray(l.array),l.buffers=[this.buffer(n.ARRAY_BUFFER,c)];for(let h=0;h<
Vs;h+=1)n.enableVertexAttribArray(h),n.vertexAttribDivisor(h,1);return l}landOf(e){let t=this.graphics.context,r=this.parts.
get("land"),n=this.parts.get("position"),s=this.emptyArray();if(!r||!n)return s;let i=this.header.geometry.triangles?r.data:
wo(r);t.bindVertexArray(s.array);let o=pt(n.data,e);return s.buffers=[this.buffer(t.ARRAY_BUFFER,o),this.buffer(t.ELEMENT_ARRAY_BUFFER,
i)],s.count=i.length,t.enableVertexAttribArray(0),t.vertexAttribPointer(0,3,t.FLOAT,!1,0,0),s}};function wo({data:a,shape:[
e,t]}){let r=[];for(let n=0;n<e*t;n+=1){if(!a[n])continue;let s=n+Math.floor(n/t),i=s+t+1;r.push(s,s+1,i+1,s,i+1,i)}return Uint32Array.
from(r)}var[Mo,Ao]=[.01,.2],[ne,Us]=[4,24],Ds=9;function Bs(a,e,t){let r={lines:{"from saddle":[],"to saddle":[],"stable orbit":[],
"unstable orbit":[]},points:[]};for(let s=0;s<Math.min(a.length/ne,t.points);s+=1){let i=a[ne*s+3];(r.points[i]??=[]).push(
...[0,1,2].map(o=>a[ne*s+o]))}let n=NaN;for(let s=0;s<e.length/ne;s+=1){let i=e[ne*s+3];if(i>=qe.saddle*t.saddles)continue;
let o=i&qe.orbit?["stable orbit","unstable orbit"]:["from saddle","to saddle"],c=r.lines[o[i&qe.leaving?0:1]];i!==n&&c.push(
[]),n=i,c[c.length-1].push(...[0,1,2].map(l=>e[ne*s+l]))}return r}function Eo(a,e){let t=[];for(let r=0;r<a.length;r+=ne)
a[r+3]===e&&t.push(a[r],a[r+1],a[r+2]);return Float32Array.from(t)}function Ie(a,e=!1){let t=Float32Array.from(a.flat());
if(e)return Ne(t,Array.from({length:2*t.length/3},(s,i)=>i>>1),3);let r=[],n=0;for(let s of a){let i=s.length/3;for(let o=n;o<
n+i-1;o+=1)r.push(o,o+1);n+=i}return Ne(t,r,3)}var kt=class{graphics;header;parts;array=null;buffer=null;drawn=null;constructor(e,t,r){
this.graphics=e,this.header=t,this.parts=r}kinds(e){let t=this.header.structure?.parts??[];return Object.keys(we).filter(
r=>t.includes(r)&&Number(e[we[r]])>0)}lacking(e,t){let r=Or(t);return this.kinds(e).flatMap(n=>this.parts.has(`${n}/${r}`)?
[]:[[n,r]])}get program(){let{lineVertex:e,lineFragment:t}=this.header.shaders;return this.graphics.programs.get(e,t,"FL\
OWTEX_BODY","FLOWTEX_MARK")}isReady(e){return!this.kinds(e).length||this.program.ready}shown(e,t,r){let s=this.kinds(e).
includes(r)?this.parts.get(`${r}/${Or(t)}`):void 0;return[s?Number(e[we[r]]):0,s]}legend(e,t){let[r,n]=this.shown(e,t,"c\
ritical"),s=new Set;for(let m=0;m<Math.min(r,n?.shape[0]??0);m+=1)s.add(Number(n?.data[ne*m+3]));let{kinds:i=[],lines:o={},
nullclines:c=[]}=this.header.structure??{},[l,h]=this.shown(e,t,"separatrices"),u=Object.entries(Bs([],h?.data??[],{points:0,
saddles:l}).lines).filter(([,m])=>m.length).map(([m])=>({name:m,color:o[m]}));return this.shown(e,t,"nullclines")[0]&&u.
push(...c),[...i.filter((m,p)=>s.has(p)),...u.map(m=>({...m,isLine:!0}))]}draw({camera:e,anchor:t,width:r,height:n,ratio:s},i,o){
let{header:c,graphics:l}=this,{structure:h,geometry:u}=c,m=h&&this.layers(h,i,o);if(!h||!m?.length)return;let p=l.context,
[f,d,b,g]=e.eye,y=N(u.frame,S([f,d,b],k(u.center,g))),v=s*_(Math.sqrt(n/s/h.usualHeight),...h.widthRange),x=g?1:e.distance/
Math.hypot(...y);p.bindVertexArray(this.array),p.enable(p.BLEND),p.blendFuncSeparate(p.SRC_ALPHA,p.ONE_MINUS_SRC_ALPHA,p.
ZERO,p.ONE),p.depthFunc(p.LEQUAL);let w=this.program;l.programs.use(w,{u_matrix:G(u,e,t),u_anchor:t,u_eye:[...S(y,k(t,g)),
g],u_picture:[r,n],u_horizon:[0,0,0,1]}),p.bindBuffer(p.ARRAY_BUFFER,this.buffer);for(let{first:M,count:A,color:E,width:T,
above:L}of m){let[F,I,H,W=1]=E;l.programs.use(w,{u_width:T*v,u_nearer:Mo*x*(1+Ao*L)});for(let C of[0,1])p.vertexAttribPointer(
C,3,p.FLOAT,!1,Us,Us*(M+C/2)),p.vertexAttrib4f(2+C,F,I,H,W);p.drawArraysInstanced(p.TRIANGLE_STRIP,0,4,A)}p.bindVertexArray(
null),p.depthFunc(p.LESS),p.disable(p.BLEND)}layers(e,t,r){let[[n,s],[i,o],[,c]]=["critical","separatrices","nullclines"].
map(w=>this.shown(t,r,w)),l=JSON.stringify([n,s?.digest,i,o?.digest,c?.digest,Or(r)]);if(this.drawn?.key===l)return this.
drawn.layers;let h=Bs(s?.data??[],o?.data??[],{points:n,saddles:i}),{line:u,dot:m,rim:p,middle:f}=e,d=[],b=[],g=0,y=(w,M,A,E)=>{
let T=w.length/6;T&&d.push({first:g,count:T,color:M,width:A,above:E}),b.push(w),g+=T},v=e.nullclines.map((w,M)=>Eo(c?.data??
[],M));v.forEach(w=>y(w,p,u[0],0)),v.forEach((w,M)=>y(w,e.nullclines[M].color,u[1],1)),y(Ie(Object.values(h.lines).flat()),
p,u[0],1.5),Object.entries(h.lines).forEach(([w,M],A)=>y(Ie(M),e.lines[w],u[1],2+A));let x=e.kinds.map((w,M)=>h.points[M]??
[]);return y(Ie(x,!0),p,m[0],6),e.kinds.forEach(({color:w},M)=>y(Ie([x[M]],!0),w,m[1],7)),y(Ie(x.filter((w,M)=>e.kinds[M].
turns),!0),f,m[2],8),this.send(b),this.drawn={key:l,layers:d},d}send(e){let{graphics:t}=this,r=t.context;this.array??=t.
counted(r.createVertexArray()),this.buffer??=t.counted(r.createBuffer()),r.bindVertexArray(this.array),r.bindBuffer(r.ARRAY_BUFFER,
this.buffer),r.bufferData(r.ARRAY_BUFFER,Float32Array.from(e.flatMap(n=>[...n])),r.STATIC_DRAW);for(let n of[0,1])r.enableVertexAttribArray(
n),r.vertexAttribDivisor(n,1);r.bindVertexArray(null)}at({place:e,position:t,height:r},n,s,i){let{geometry:o,structure:c}=this.
header,[l,h]=this.shown(s,i,"critical"),u=2*n.height/Math.max(r,1),[m,p]=["",Ds];for(let f=0;f<Math.min(l,h?.shape[0]??0);f+=
1){let[d,b,g,y]=[0,1,2,3].map(M=>Number(h?.data[ne*f+M])),v=P(Q(o.frame,[d,b,g]),o.center),x=n.project(v);if(!x||Math.hypot(
...S(v,t))>4*Ds*u)continue;let w=.5*r*Math.hypot((x[0]-e[0])*n.aspect,x[1]-e[1]);w<p&&([m,p]=[c?.kinds[y]?.name??"",w])}
return m}dispose(){this.graphics.free("Buffer",this.buffer),this.graphics.free("VertexArray",this.array),this.array=this.
buffer=this.drawn=null}};function Or([a,e,t]){return t<.5?a:e}var Hs=5;function zs(a,e){let t=Math.max(Math.ceil((a-1)/e),1);return Array.from({length:t},(r,n)=>({first:n*e,cells:Math.
min(a-1-n*e,e)}))}var Ot=class{mesh;limits;rows;columns;constructor(e,t){this.mesh=e,this.limits=t,this.rows=zs(e.shape[0],
t.tileCells),this.columns=zs(e.shape[1],t.tileCells)}get shape(){return[this.rows.length,this.columns.length]}levels({eye:e,
halfHeight:t,pixels:r}){let{limits:n}=this,{blocks:s}=this.mesh,i=this.rows.length*this.columns.length,o=s.length/i,c=o-
Hs-1;return Int8Array.from({length:i},(l,h)=>{let u=s.subarray(o*h,o*(h+1)),[m,p,f,d,b]=u.subarray(o-Hs),g=n.leastDistance*
d,y=e?Math.max(R(S(e,[m,p,f]))-d,g):1,v=.5*r/(t*Math.max(y,Number.MIN_VALUE)),x=0;for(;x<c;x+=1){let w=u[x+1],M=b*v*2**(x+
1);if(!(w*v<=n.maxErrorPixels||Number.isFinite(w)&&M<=1)||M>n.maxSideHeights*r)break}return x})}triangles(e,t){let r=Array.
from(e,i=>i<0?0:this.limits.tileCells>>i),n=new Uint32Array(6*r.reduce((i,o)=>i+o*o,0)),s=0;return e.forEach((i,o)=>{i>=
0&&(s=this.add(n,s,i,t,o))}),n.slice(0,s)}add(e,t,r,n,s){let{rows:i,columns:o,limits:c}=this,{shape:l,cells:h}=this.mesh,
u=1<<r,m=c.tileCells/u+1,p=i[Math.floor(s/o.length)],f=o[s%o.length],[d,b,g,y]=[0,1,2,3].map(A=>n[4*s+A]),v=(A,E,T)=>A===
E?A:A>>T<<T,x=new Uint32Array(m*m);for(let A=0;A<m;A+=1){let E=Math.min(A*u,p.cells);for(let T=0;T<m;T+=1){let[L,F]=[Math.
min(T*u,f.cells),E];(A===0||A===m-1)&&(L=v(L,f.cells,A?b:d)),(T===0||T===m-1)&&(F=v(F,p.cells,T?y:g)),x[A*m+T]=(p.first+
F)*l[1]+f.first+L}}let w=t,M=(A,E,T)=>{A===E||E===T||A===T||(e[w++]=A,e[w++]=E,e[w++]=T)};for(let A=0;A<m-1;A+=1){let E=Math.
min(p.first+Math.min(A*u,p.cells),l[0]-2);for(let T=0;T<m-1;T+=1){let L=Math.min(f.first+Math.min(T*u,f.cells),l[1]-2);if(h&&
!h[E*(l[1]-1)+L])continue;let F=A*m+T,[I,H,W,C]=[x[F],x[F+1],x[F+m+1],x[F+m]];M(I,H,W),M(I,W,C)}}return w}},So=99,Ft=class{values;strides;count;width;constructor([
e,t],r){[this.count,this.width]=r?[t+1,e]:[e+1,t],this.strides=r?[1,t+1]:[t,1],this.values=new Int16Array(this.count*this.
width)}at(e,t){return e*this.strides[0]+t*this.strides[1]}close(){for(let e=0;e<this.width;e+=1){let[t,r]=[this.at(0,e),
this.at(this.count-1,e)],n=Math.max(this.values[t],this.values[r]);this.values[t]=this.values[r]=n}}};function Gs({step:a,
row:e,column:t,shape:r},[n,s],i){let o=Math.min(e+(r[0]<<a),n),c=Math.min(t+(r[1]<<a),s);for(let l=e;l<o;l+=1){let h=(l-
e>>a)*r[1];for(let u=t;u<c;u+=1)i(l*s+u,h+(u-t>>a))}}function To(a,[e,t],r){let n=(s,i,o,c)=>c?(s+i+o)%o:_(s+i,0,o-1);return a.
map((s,i)=>{let[o,c]=[Math.floor(i/t),i%t],l=s;for(let h of[-1,1]){let u=n(o,h,e,r[0]),m=n(c,h,t,r[1]);l=Math.min(l,a[u*
t+c],a[o*t+m])}return l})}function Ws(a,e,t,r){let n=new Int16Array(e[0]*e[1]).fill(So),s=(l,h,u)=>Gs(h,e,(m,p)=>{h.levels[p]>=
0&&(l[m]=u(h.levels[p]))});for(let l of a)s(n,l,()=>l.step);let i=To(n,e,t),o=new Int16Array(n.length);for(let l of a){let{
levels:h,step:u}=l;Gs(l,e,(m,p)=>{h[p]=Math.min(h[p],i[m]+r-u)}),s(o,l,m=>m+u)}let c=[new Ft(e,0),new Ft(e,1)];for(o.forEach(
(l,h)=>{let[u,m]=[Math.floor(h/e[1]),h%e[1]];[[u,m],[m,u]].forEach(([p,f],d)=>{let{values:b}=c[d];for(let g of[0,1]){let y=c[d].
at(p+g,f);b[y]=Math.max(b[y],l)}})});;){c.forEach((h,u)=>t[u]&&h.close());let l=a.map(h=>_o(h,c));if(!l.some(([,h])=>h))
return l.map(([h])=>h)}}function _o({step:a,row:e,column:t,shape:r,levels:n},s){let i=1<<a,o=new Int8Array(4*n.length),c=!1;
for(let l of[0,1,2,3]){let[h,u]=[l>>1,l&1],m=s[h],{values:p}=m;n.forEach((f,d)=>{let b=[Math.floor(d/r[1]),d%r[1]],[g,y]=h?
[t,e]:[e,t],v=Math.min(g+(b[h]+u)*i,m.count-1),x=y+b[1-h]*i,w=Math.max(Math.min(x+i,m.width),x+1),M=0;for(let A=x;A<w;A+=
1)M=Math.max(M,p[m.at(v,A)]);if(o[4*d+l]=M-a,!(f<0))for(let A=x;A<w;A+=1)c||=p[m.at(v,A)]!==M,p[m.at(v,A)]=M})}return[o,
c]}var js={position:["position","coordinate"],normal:["normal"],cells:["index"],mesh:["index"],triangles:["index","position",
"coordinate","corners","normal","scalar"],blocks:["index"],cmap:["cmap"],noise:["noise"],step:["step"],scalars:["scalar"]},
$s=["padded","unit","open","nearest","rays"],Po=8*(4/3),Ro=0,Se=class{graphics;header;parts;earth;bodies;arrows;marks;tile;anchor=[
0,0,0];resources=new Map;scalarSteps="";drawn=null;meshLevels=null;tracing="";number=Ro+=1;constructor(e,t,r,n=null){this.
tile=n,this.graphics=e,this.header=t,this.parts=r,this.earth=new Lt(e,t,r),this.bodies=new Rt(e,t,r),this.arrows=new _t(
e,t,r),this.marks=new kt(e,t,r)}isReady(e){let t=[!1,!0].map(n=>this.arrows.program(e,n));return[this.earth.isReady,this.
bodies.isReady,this.marks.isReady(e)].every(Boolean)&&t.every(n=>n?.ready??!0)}missing(e,t){let{geometry:r,slices:n,scalars:s,
paper:i,pyramid:o,formula:c}=this.header,{trace:l}=n,h=["mesh",...l?.parts??["position",...r.planar?[]:["normal"]]];o&&!c&&
h.push("places"),this.header.bodies?.runs.length&&h.push(...Fe),r.triangles&&h.push("triangles","blocks");for(let u of new Set(
[e,t]))l?h.push(...ie(this.header,u).map(m=>`flow/${m}`)):h.push(`slices/${u}`),n.channels===2&&h.push(`extra/${u}`);return h.
push(...this.scalarParts(e,t)),s.name!==null&&h.push("cmap"),i&&h.push("noise","step"),[...new Set(h)].filter(u=>!this.fits(
u))}lacking(e){let t=this.missing(e,e).map(r=>r.startsWith("flow/")?K(r):e);return[...new Set(t)]}scalarParts(e,t,r=this.
header.scalars){let{name:n,steps:s,number:i}=r;if(n===null)return[];let o=i?`/${i}`:"";return(s>1?[e,t]:[0,0]).map(c=>`s\
calars/${c}${o}`)}fits(e){let t=this.parts.get(e);if(!t)return!1;let{geometry:r,slices:n,paper:s,mesh:i}=this.header,o=r.
shape.map(u=>Math.max(Math.ceil((u-1)/i.tileCells),1)),c=n.trace?.nodes??[],h={flow:[...c,t.shape[2]],unit:c,padded:[...c.
map(u=>u+2),3],slices:[n.count,r.rows.size,r.columns.size,n.channels],position:[...r.shape,3],mesh:r.triangles?t.shape:[
...o,t.shape[2]],step:s?[s.size[1],s.size[0]]:[]}[e.split("/")[0]];return!h||String(h)===String(t.shape)}make(e,t){let{slices:r,
geometry:n}=this.header,{trace:s}=r;if(!s)return!0;let i=this.part("padded"),o=c=>this.key(["padded"],c,s);return this.put(
"position",o("position"),()=>On(i,s,n.shape)),!n.planar&&!s.parts.includes("normal")&&this.put("normal",o("normal"),()=>Fn(
i,s,n.shape)),e.every(c=>this.trace(c,t))}prepare(){let{trace:e}=this.header.slices;e&&rt(this.graphics,this.header,e)}trace(e,t){
let{graphics:r,header:n}=this,{trace:s,lags:i,sides:o}=n.slices,c=`slices/${e}`;if(!s||this.resources.has(c))return!0;let l=ie(
n,e).map(m=>`flow/${m}`),h=this.key([...l,...$s],e,s,i,o,n.geometry.levels),u=null;if(!h||!r.common.has(`slices ${h}`)){
let{tracings:m}=r,p=h||`${this.number} ${e}`;this.tracing!==p&&this.stopTracing();let f=b=>this.parts.get(b),d=m.get(p)??
new nt(r,n,s,f,e);if(m.set(this.tracing=p,d),u=d.advance(t),!u)return!1;this.stopTracing()}return this.take(c,"Texture",
h,()=>u,()=>{}),!0}put(e,t,r){let{graphics:n,parts:s}=this;if(s.get(e)?.digest===t)return;let i=n.stock.get(t)?.part??{...r(),
digest:t};n.release(s.get(e)),s.set(e,n.hold(i)),this.forget(e)}isMade(e){return!this.missing(e[0],e[e.length-1]).length&&
(!this.header.slices.trace||this.isLoaded(e))}stopTracing(){this.graphics.tracings.get(this.tracing)?.dispose(),this.graphics.
tracings.delete(this.tracing),this.tracing=""}part(e){let t=this.parts.get(e);if(!t)throw new Error(`the part "${e}" of \
the scene is missing`);return t}forget(e){let[t,r]=e.split("/");js[t]?.includes("index")&&(this.meshLevels=this.drawn=null),
["position","cells","triangles"].includes(t)&&this.arrows.forget();let n=["slices","extra","flow"].includes(t);!n&&t!=="\
scalars"&&this.earth.forget(e),Fe.includes(t)&&this.bodies.dispose();for(let s of n?[`slices/${r}`]:js[t]??[])this.drop(
s);$s.includes(t)&&this.dropSlices(NaN,NaN),this.drop("array")}drop(e){let t=this.resources.get(e);this.resources.delete(
e),t&&(t.users-=1,!t.users&&(this.graphics.free(t.kind,t.object),this.graphics.common.delete(t.key)))}dispose(){for(let e of[
...this.resources.keys()])this.drop(e);this.stopTracing(),this.earth.dispose(),this.bodies.dispose(),this.arrows.dispose(),
this.marks.dispose()}key(e,...t){let r=e.map(n=>this.parts.has(n)?this.part(n).digest:"none");return r.every(Boolean)?JSON.
stringify([r,t]):""}take(e,t,r,n,s){let i=this.resources.get(e);if(i)return i.object;let{graphics:o}=this,c=r&&`${e.split(
"/")[0]} ${r}`,l=c?o.common.get(c):void 0,h=l?.object??o.counted(n()),u=l??{kind:t,object:h,count:0,key:c,users:0};return u.
users+=1,this.resources.set(e,u),l||(u.count=s(h)||0),c&&o.common.set(c,u),h}buffer(e,t,r,n=!1){let s=this.graphics.context,
i=o=>{let c=n?s.ELEMENT_ARRAY_BUFFER:s.ARRAY_BUFFER,l=r();return s.bindVertexArray(null),s.bindBuffer(c,o),s.bufferData(
c,l,s.STATIC_DRAW),l.length};return this.take(e,"Buffer",t,()=>s.createBuffer(),i)}mesh(){if(this.meshLevels)return this.
meshLevels;let{geometry:e,mesh:t}=this.header;if(e.triangles)return this.meshLevels=new gt(this.part("mesh"),this.part("\
blocks"));let{shape:r,periodic:n}=e,s={blocks:this.part("mesh").data,cells:this.parts.get("cells")?.data};return this.meshLevels=
new Ot({shape:r,periodic:n,...s},t)}cornersAt(e){let{triangles:t,shape:r}=this.header.geometry;return t?ts(this.part("tr\
iangles").data,e):Xn(r,e)}levels(e){return{levels:this.mesh().levels(e),shape:this.mesh().shape}}get hasTriangles(){return this.
drawn!==null}setTriangles(e,t=new Int8Array){let{drawn:r}=this;r&&String([e,t])===String([r.levels,r.joins])||(this.drawn=
{levels:e,joins:t},this.drop("index"),this.drop("array"))}isLoaded(e){return e.every(t=>this.resources.has(`slices/${t}`))}get tracedBytes(){
let{slices:e,geometry:t}=this.header;return e.trace?[...this.resources.keys()].filter(n=>n.startsWith("slices/")).length*
Po*e.count*t.rows.size*t.columns.size:0}load(e){for(let t of e)this.slices(t)}bindNodes(e,t,r){let n=this.graphics.context,
s=String(this.scalarParts(e,t)),i=s!==this.scalarSteps?["scalar","array"]:[];r.some((l,h)=>l!==this.anchor[h])&&i.push("\
position","array");for(let l of i)this.drop(l);this.scalarSteps=s,this.anchor=r;let o=l=>this.fillArray(l,e,t),c=()=>n.createVertexArray();
n.bindVertexArray(this.take("array","VertexArray","",c,o))}fillArray(e,t,r){let n=this.graphics.context,{geometry:s,paper:i,
scalars:o}=this.header,{shape:c,rows:l,columns:h}=s,{levels:u,joins:m}=this.drawn??{levels:new Int8Array,joins:new Int8Array},
p=(I,...H)=>this.key(["triangles",...I],...H),f=()=>this.mesh().triangles(u,m),d=p(["cells","mesh","blocks"],c,[...u],[...m]),
b=this.buffer("index",d,f,!0),g=s.triangles?this.part("triangles").data:null,y=(I,H,W)=>g?Er(I,W?g.map((C,Z)=>Z/3):g,H):
I,v=()=>y(pt(this.part("position").data,this.anchor),3),x=s.planar?null:this.part("normal").data,w=I=>g?Qn(I,this.part("\
position").data,g):I,[M,A]=this.shares(t,r),E=JSON.stringify([c,l,h,g?.length]),T=()=>g?Zn(g.length/3):ft(s),L=n.FLOAT;x instanceof
Int8Array&&(L=n.BYTE),x instanceof Int16Array&&(L=n.SHORT);let F=[[this.buffer("position",p(["position"],this.anchor),v),
3,n.FLOAT],[this.buffer("coordinate",E,T),2,n.FLOAT],[x&&this.buffer("normal",p(["normal"]),()=>w(x)),3,L],[i&&this.buffer(
"along","",()=>Yn(i)),2,n.FLOAT],[g&&this.buffer("scalar",M,()=>y(A(),2,o.flat)),2,n.FLOAT],[g&&this.buffer("corners",p(
[]),()=>es(g)),3,n.FLOAT]];n.bindVertexArray(e),n.bindBuffer(n.ELEMENT_ARRAY_BUFFER,b),F.forEach(([I,H,W],C)=>{I&&(n.bindBuffer(
n.ARRAY_BUFFER,I),n.enableVertexAttribArray(C),n.vertexAttribPointer(C,H,W,W!==n.FLOAT,0,0))})}shares(e,t){let{geometry:r,
scalars:n}=this.header,{shape:s}=r,i=this.scalarParts(e,t);return[this.key(["triangles",...new Set(i)],s,n.low,n.high,n.
log),()=>dt(i.map(l=>this.part(l).data),n)]}nodalShares(e,t){let r=this.graphics.context,[n,s]=this.header.geometry.shape,
[i,o]=this.shares(e,t);return this.texture("scalar",i,c=>{r.bindTexture(r.TEXTURE_2D,c),r.texImage2D(r.TEXTURE_2D,0,r.RG32F,
s,n,0,r.RG,r.FLOAT,o()),r.texParameteri(r.TEXTURE_2D,r.TEXTURE_MIN_FILTER,r.NEAREST),r.texParameteri(r.TEXTURE_2D,r.TEXTURE_MAG_FILTER,
r.NEAREST)})}texture(e,t,r){let n=this.graphics.context;return this.take(e,"Texture",t,()=>n.createTexture(),r)}slices(e){
let{slices:t,geometry:r}=this.header,n=this.key([`slices/${e}`,`extra/${e}`],r.levels,t.extra);return this.texture(`slic\
es/${e}`,n,s=>{let i=this.part(`slices/${e}`),[o,c,l,h]=i.shape,u=i.data,m=this.parts.get(`extra/${e}`)?.data,p=c*l,f=d=>{
let b=u.subarray(d*p*h,(d+1)*p*h);if(h===4)return b;let g=new Uint16Array(4*p),y=t.extra.indexOf(d),v=y<0?null:m?.subarray(
y*p,(y+1)*p);for(let x=0;x<p;x+=1)g[4*x]=b[2*x],g[4*x+1]=b[2*x+1],v&&(g[4*x+3]=v[x]);return g};this.fill(s,{width:l,height:c,
layers:o,channels:4,levels:r.levels},f)})}get pickers(){let{programs:e}=this.graphics,{vertex:t,pick:r,fullVertex:n,probe:s}=this.
header.shaders;return[e.get(t,r),e.get(n,s)]}texels(e,t){let{graphics:r,header:n}=this,s=r.context,{slices:i,geometry:o}=n,
c=o.columns.size,l=this.slices(e),h=()=>{s.activeTexture(s.TEXTURE0),s.bindTexture(s.TEXTURE_2D_ARRAY,l),s.bindVertexArray(
null);let p=t.flatMap(f=>[f%c,Math.floor(f/c)]);r.programs.use(this.pickers[1],{u_texels:p}),s.drawArrays(s.TRIANGLES,0,
3)},u=r.numbers(h,t.length,i.count),m=new Float32Array(u.buffer);return(p,f)=>{let[d,b,g,y]=m.subarray(4*(p*t.length+f));
return[d,b,g,y]}}image(e,t){let r=this.graphics.context;return this.texture(e,this.key([e],t),n=>{let{data:s,shape:i}=this.
part(e),[o,c,l=1]=i,h=Math.floor(Math.log2(Math.max(c,o))),u={width:c,height:o,layers:1,channels:l,levels:h};this.fill(n,
u,()=>s);let m=p=>t[p]?r.REPEAT:r.CLAMP_TO_EDGE;r.texParameteri(r.TEXTURE_2D_ARRAY,r.TEXTURE_WRAP_S,m(1)),r.texParameteri(
r.TEXTURE_2D_ARRAY,r.TEXTURE_WRAP_T,m(0))})}fill(e,t,r){let{context:n,floats:s}=this.graphics;Qe(n,e,t);for(let i=0;i<t.
layers;i+=1)et(n,s?{...t,levels:0}:t,i,r(i));s&&t.levels&&n.generateMipmap(n.TEXTURE_2D_ARRAY)}colourMap(){let e=this.graphics.
context,{scalars:t}=this.header;return this.texture("cmap",this.key(["cmap"],t.beyond),r=>{e.bindTexture(e.TEXTURE_2D,r);
let n=dn(this.parts.get("cmap")?.data??new Uint8Array(4),t);e.texImage2D(e.TEXTURE_2D,0,e.RGBA32F,n.length/4,1,0,e.RGBA,
e.FLOAT,n),e.texParameteri(e.TEXTURE_2D,e.TEXTURE_MIN_FILTER,e.NEAREST),e.texParameteri(e.TEXTURE_2D,e.TEXTURE_MAG_FILTER,
e.NEAREST)})}dropSlices(e,t){let r=t+1<this.header.slices.steps?t+1:0;for(let n of[...this.resources.keys()])n.startsWith(
"slices/")&&([e,t,r,t+1].includes(K(n))||this.drop(n))}bindTextures(e,t){let r=this.graphics.context,{geometry:n,paper:s,
scalars:i}=this.header,o=s?.repeat??[!1,!1];[this.slices(e),t===e?null:this.slices(t),s&&this.image("noise",s.picture?[!0,
!0]:o),s&&this.image("step",o),this.colourMap(),n.triangles||i.name===null?null:this.nodalShares(e,t)].forEach((l,h)=>{r.
activeTexture(r.TEXTURE0+h),r.bindTexture(h<4?r.TEXTURE_2D_ARRAY:r.TEXTURE_2D,l)}),r.activeTexture(r.TEXTURE0+gr.length)}get triangles(){
return(this.resources.get("index")?.count??0)/3}draw(e,t,r,n){let s=this.graphics.context;this.bindNodes(e,t,r),n&&(this.
dropSlices(e,t),this.bindTextures(e,t)),s.drawElements(s.TRIANGLES,this.resources.get("index")?.count??0,s.UNSIGNED_INT,
0),s.bindVertexArray(null)}};var Lo=60,ko=25,Oo=9e8,Fo=3.5,No={slices:4,flow:24},Nt=class{layers=[];missing=[];wanted=0;pending=0;host;root;tiles=new Map;pyramid=null;chosen={
choices:new Map,steps:[],names:""};drawn="";count=0;isWaiting=!1;hasAsked=!1;isOver=!1;failed=new Ee;constructor(e,t){this.
host=e,this.root=t}has(e,t){return this.tiles.get(e)?.parts.has(t)??!1}fail(e,t){this.failed.add(this.need(e,t)),this.host.
refine()}need(e,t){return`${e} ${t} ${this.root.header.scalars.name}`}dispose(){this.isOver=!0;for(let e of[...this.tiles.
keys()])this.drop(e)}setPart(e,t){let{graphics:r,header:n}=this.root,s=this.tiles.get(e)??this.emptyTile();if(this.tiles.
set(e,s),t.digest&&s.parts.get(t.name)?.digest===t.digest)return;if(r.release(s.parts.get(t.name)),s.parts.set(t.name,r.
hold(t)),t.name==="header"){let l=JSON.parse(new TextDecoder().decode(t.data));s.scene?.dispose(),l&&(l.geometry.reach=n.
geometry.reach),s.scene=l&&new Se(r,{...n,...l,pyramid:null,bodies:null,structure:null},s.parts,oe(e)),this.giveMap(s)}else
s.scene?.forget(t.name);let{names:i,steps:o}=this.chosen;this.missing=this.missing.filter(l=>!this.isHere(l,o));let c=wr(
this.chosen.choices,l=>this.isHere(l,o));String([...c.keys()])!==i&&this.host.refine()}recolour(e={}){let{steps:t}=this.
chosen;for(let r of this.tiles.values()){let{scene:n,parts:s}=r;if(!n||(Object.assign(n.header,e),this.giveMap(r),n.forget(
"scalars"),(t.length?n.scalarParts(t[0],t[t.length-1]):[]).every(c=>s.has(c))))continue;let o=[...s.keys()].filter(c=>c.
startsWith("scalars/"));for(let c of o)this.release(r,c)}}emptyTile(){return{parts:new Map,scene:void 0,used:this.count}}giveMap({
scene:e,parts:t}){let r=this.root.parts.get("cmap");r&&t.set("cmap",r),e?.forget("cmap")}arrange([e,t]){let{camera:r,canvas:n}=this.
host;if(!r)return[];let s=[...new Set([e,t])],i=this.choose(r,s),o=[{scene:this.root,key:[this.root.header.pyramid?.depth??
0,0,0]}],c=[j];for(let u of i.keys()){let m=this.tiles.get(u)?.scene;m&&(c.push(u),o.push({scene:m,key:oe(u)}))}let l=r.
sight(n.height),h=o.map(({scene:u,key:m},p)=>{let{levels:f,shape:d}=u.levels(l);for(let v of i.get(c[p])??[])this.hide(f,
d[1],v,c[p]);let{pyramid:b}=this.root.header,[g,y]=m.slice(1).map(v=>v*(b?.tileBlocks??0)<<m[0]);return{step:m[0],row:g,
column:y,shape:d,levels:f}});return this.layers=o,this.setTriangles(c,h),o.map(({scene:u})=>u)}hide(e,t,r,n){let[s,i,o]=this.
pyramid?.finerPart(oe(r),n)??[0,0,0];for(let c=s;c<Math.min(s+o,e.length/t);c+=1)e.fill(-1,c*t+i,c*t+Math.min(i+o,t))}setTriangles(e,t){
let r=String(t.map(({levels:u},m)=>[e[m],u]));if(r===this.drawn&&this.layers.every(({scene:u})=>u.hasTriangles))return;this.
drawn=r;let{geometry:n,mesh:s,pyramid:i,formula:o}=this.root.header,c=Math.log2(s.tileCells),l=i?.blocks[0]??t[0].shape,
h=n.triangles||o?[]:Ws(t,l,n.periodic,c);t.forEach(({levels:u},m)=>this.layers[m].scene.setTriangles(u,h[m]))}choose(e,t){
let{header:r}=this.root,{settings:n,canvas:s,ratio:i}=this.host;if(!r.pyramid)return new Map;this.pyramid??=new ht(r.pyramid,
Vn(r)??this.root.part("places").data);let o=this.pyramid.choose({...e.sight(s.height/i),planes:e.planes,cellPixels:Dn(r.
pyramid,n)});this.count+=1;for(let u of o.keys()){let m=this.tiles.get(u);m&&(m.used=this.count)}let c=performance.now()+
ko,l=this.obtainable(Bn(o),t,r.pyramid.depth);this.missing=l.filter(u=>!this.isHere(u,t)),this.ask(),this.trim(t);for(let u of l)
this.isHere(u,t)&&this.load(u,t,c);let h=wr(o,u=>this.isHere(u,t)&&this.load(u,t,c));return this.wanted=l.length,this.pending=
l.filter(u=>!this.isHere(u,t)||!this.isLoaded(u,t)).length,this.chosen={choices:o,steps:t,names:String([...h.keys()])},h}obtainable(e,t,r){
let n=[t,...t.map(o=>[o])],s=o=>n.some(c=>this.failed.has(this.need(o,c))),i=e.map(o=>{let[c,l,h]=oe(o);for(;c<r&&s(B([c,
l,h]));)[c,l,h]=[c+1,l>>1,h>>1];return c<r?B([c,l,h]):j});return[...new Set(i)].filter(o=>o!==j)}isHere(e,t){let r=this.
tiles.get(e)?.scene;return r===null||r?.missing(t[0],t[t.length-1]).length===0}isLoaded(e,t){let r=this.tiles.get(e)?.scene;
return r===null||(r?.isLoaded(t)??!1)}load(e,t,r){let n=this.tiles.get(e)?.scene;return!n||this.isLoaded(e,t)?!0:performance.
now()>r||!n.make(t,r)?(this.host.refine(),!1):(n.load(t),!0)}ask(){let{requests:e,lifetime:t}=this.host;!e||this.isWaiting||
!(this.missing.length||this.hasAsked)||(this.isWaiting=!0,t.later(()=>{if(this.isWaiting=!1,this.isOver)return;this.hasAsked=
this.missing.length>0;let r=(i,o)=>this.tiles.get(i)?.scene?.lacking(o)??ie(this.root.header,o),n=this.missing.flatMap(i=>this.
chosen.steps.flatMap(o=>r(i,o))),s=[...new Set(n)].sort((i,o)=>i-o);e.wantTiles(this.missing.map(oe),s)},Lo))}trim(e){let t=0;
for(let[r,n]of[...this.tiles].sort(([,s],[,i])=>i.used-s.used)){let{parts:s,scene:i,used:o}=n,c=i?.header.slices.trace?"\
flow":"slices",l=[...s.keys()].filter(u=>u.startsWith(`${c}/`)),h=i?e.flatMap(u=>ie(i.header,u)):e;for(let u of l.slice(
0,Math.max(l.length-No[c],0))){let m=K(u);if(h.includes(m))continue;for(let f of[c,"extra"])this.release(n,`${f}/${m}`);
let p=[...s.keys()].filter(f=>Me(f,m,this.root.header));for(let f of p)this.release(n,f)}for(let{data:u}of s.values())t+=
Fo*u.byteLength;t+=i?.tracedBytes??0,t>(this.host.options.source?.memory??Oo)&&o<this.count&&this.drop(r)}}drop(e){let t=this.
tiles.get(e);t?.scene?.dispose();for(let r of[...t?.parts.keys()??[]])this.release(t,r);this.tiles.delete(e)}release(e,t){
t!=="cmap"&&this.root.graphics.release(e?.parts.get(t)),e?.parts.delete(t)}};var It=class{scene=null;tiles=null;shown=null;view;renderer;next=[];constructor(e){this.view=e,this.renderer=new xt(e,this),
!e.graphics.gl&&e.panel.fail("This browser has no WebGL2, which is needed to draw the picture.","Turn on hardware accele\
ration in its settings, or use a recent Firefox, Chrome or Safari.")}open(e){let{view:t}=this;this.leave(),this.scene=new Se(
t.graphics,e,t.parts),this.tiles=new Nt(t,this.scene)}leave(){this.tiles?.dispose(),this.scene?.dispose(),this.tiles=this.
scene=null}dispose(){this.leave(),this.renderer.dispose()}restart(e){this.renderer.restart(e)}resize(e,t){this.renderer.
resize(e,t)}refine(){this.renderer.refine()}arrange(e){let t=this.tiles?.arrange(e)??[];return this.view.root.dataset.tiles=
String(this.tiles?.pending??0),t}get smooth(){let{header:e,options:t}=this.view;return t.smooth!==void 0||!e?t.smooth??!1:
this.program(e).price<Mn}get isComing(){return!!this.tiles?.missing.length}get lacking(){let[e,t]=this.view.player.moment;
return this.scene?.missing(e,t)??[]}missing(e){return[...new Set(e.flatMap(t=>this.scene?.lacking(t)??[]))]}make(e,t){return this.
next=e,!this.missing(e).length&&!!this.scene?.make(e,t)}available(e){let{view:t,scene:r,shown:n,lacking:s}=this,{header:i,
player:o}=t;if(!i||!r)return null;let c=o.moment,l=o.playing?[1,2].map(p=>(c[1]+p)%i.slices.steps):[],h=this.missing([c[0],
c[1],...this.next,...l]);h.length&&t.requests.hasSteps&&!t.options.isComing?.()&&t.requests.wantSteps(h);let u=!s.length&&
r.make(c.slice(0,2),e),m=t.requests.hasMarks?r.marks.lacking(t.settings,c):[];return t.options.isComing?.()||t.requests.
wantMarks(m),t.root.dataset.lacking=String(s.length+m.length||+!u),t.panel.wait(s,u,this.renderer.leavesOut,m.length>0),
t.panel.showKinds(r.marks.legend(t.settings,c)),u&&String(c.slice(0,2))!==String(n?.slice(0,2))&&(t.trim(),t.change()),u?
this.shown=c:(s.length||t.request(),n&&r.isMade(n.slice(0,2))?n:null)}program(e,t=this.isClose(e),r=!this.view.player.playing){
let{vertex:n,fragment:s}=e.shaders,i=Cn(e,this.view.settings,t,r);return this.view.graphics.programs.get(n,s,...i)}isClose(e){
let{view:t}=this;if(!t.camera)return!1;let r=t.view([0,0,0],t.ratio),n=this.tiles?.layers.slice(1).map(({scene:s})=>s.header)??
[];return(n.length?n:[e]).some(s=>ot(s,t.settings,r))}frame(e,t){let{view:r,scene:n}=this,{graphics:s,header:i}=r;if(s.isLost||
!s.gl||!r.isVisible||!i||!n||r.canvas.width<2)return;this.next=[],r.advance(e);let o=this.available(t);r.camera||r.place();
let c=this.program(i);if(n.prepare(),!o||!r.camera)return;if(c.error)return r.panel.fail("The shader does not compile wi\
th this graphics driver.",c.error);if(!c.ready||!n.isReady(r.settings))return r.request();let l=!r.sharp&&this.renderer.
draw(c,o,t);l&&(n.pickers,i.slices.critical&&this.program(i,!0),r.player.varies&&this.program(i,this.isClose(i),!1)),r.painted(
l)}get canPick(){let{scene:e,view:t}=this,{graphics:r}=t;return!!e&&!r.isLost&&!!r.gl&&e.pickers.every(({ready:n})=>n)}find(e,t){
let{tiles:r,shown:n,view:s}=this,{camera:i,canvas:o}=s;if(!r?.layers.length||!i||!n)return null;let{anchor:c}=s.view(n,1),
l=fs({layers:r.layers,camera:i,moment:n,anchor:c,canvas:o},e,t),{marks:h}=r.layers[0].scene;if(l){let u={place:[e,t],position:l.
point.position,height:s.root.clientHeight};l.point.mark=h.at(u,i,s.settings,n)}return l}};var Ct=class{canvas=document.createElement("canvas");root=document.createElement("div");graphics=Rn();lifetime=new at;player;held=new st(
this.graphics);parts=this.held.all;isClear=!0;isVisible=!0;panel;requests;options;header;settings;painter;camera=null;sharp=!1;ratio=1;host;isNew=!0;constructor(e,{
header:t,settings:r,player:n,source:s,isComing:i}){this.host=e,this.header=t,this.settings=r,this.player=n,this.options=
{source:s,isComing:i},this.panel={wait:()=>{},showKinds:()=>{},fail:(o,c)=>e.failed(o,c)},this.requests=new ut(s,this),this.
graphics.users.add(this),n.setHeader(t),this.painter=new It(this),this.requests.setHeader(t),this.painter.open(t)}dispose(){
this.lifetime.isOver||(this.lifetime.end(),this.requests.stop(),this.painter.dispose(),this.held.clear(),this.graphics.leave(
this))}get tiles(){return this.painter.tiles}get isHeld(){return this.host.isHeld()}setPart(e){let t=ue(e.name);if(t)return void this.
tiles?.setPart(t[0],{...e,name:t[1]});this.held.set(e)&&(this.painter.scene?.forget(e.name),this.trim(),e.name==="cmap"&&
this.tiles?.recolour(),this.change())}lack(e,t,r=[]){t!==void 0&&this.tiles?.fail(t,r),this.host.failed(e,"")}trim(){this.
held.trim(this.header,this.options.source,this.player.moment.slice(0,2))}chooseColours(e){let{colours:t,part:r}=bn(this.
header,e,this.parts);r&&this.setPart(r),Object.assign(this.header,t),this.painter.scene?.forget("scalars"),this.tiles?.recolour(
t),this.change()}look(e,t,r,n){let{header:s,canvas:i}=this;this.ratio=n,this.camera=new fe(e,s.limits,s.geometry.planar,
t/r);let o=[t,r].map(c=>Math.max(Math.round(c*n),1));(o[0]!==i.width||o[1]!==i.height)&&this.painter.resize(o[0],o[1]),this.
change(!0)}place(){}advance(e){let{player:t,painter:r}=this;!t.playing||!t.advance(e,n=>r.make(n,e))||(this.host.advanced(),
this.change())}request(){this.lifetime.isOver||this.graphics.request(this)}change(e=!1){this.painter.restart(e),this.isNew=
!0,this.refine()}refine(){this.isNew||this.painter.refine(),this.sharp=!1,this.request()}painted(e){this.sharp=e&&!this.
player.playing,(this.isNew||e)&&this.host.painted(e),this.isNew=!1,this.sharp||this.request()}lost(){this.painter.open(this.
header),this.sharp=!1}frame(e,t){if(!this.lifetime.isOver)try{this.painter.frame(e,t)}catch(r){this.player.playing=!1,this.
host.failed("The flow cannot be drawn.",String(r))}}view(e,t){let{header:r,camera:n,player:s,rows:i}=this;if(!n)throw new Error(
"no camera is set yet");let o=this.painter.scene?.anchor??[0,0,0];return Wn({header:r,camera:n,anchor:o,player:s,rows:i},
e,t)}get rows(){return this.canvas.height/this.ratio}find(e,t){return this.painter.canPick?this.painter.find(e,t):null}};var Ys=`// A picture of the flow on a web map; nothing beside it.

in vec3 flowtexPlaceOut;

uniform sampler2D u_flowPicture;
uniform float u_opacity;

out vec4 flowtexOut;

void main()
{
  vec2 place = 0.5 + 0.5 * flowtexPlaceOut.xy / flowtexPlaceOut.z;
  if (flowtexPlaceOut.z <= 0.0 || place != clamp(place, 0.0, 1.0))
    discard;
  flowtexOut = u_opacity * texture(u_flowPicture, place);
}
`;var Xs=`// A piece of a web map, in the cells of a grid over a box of a tile, and where it lies in a picture of the flow\
.
// \`projectTile\` is the map's.

uniform vec4 u_box;         // its corner and its size, in the tile's own units
uniform float u_mapCells;   // cells along a side of the grid
uniform mat4 u_flowMatrix;  // from the tile to the picture's clip space

out vec3 flowtexPlaceOut;   // as x, y and w

void main()
{
  vec2 cell = vec2(gl_VertexID >> 1, gl_InstanceID + (gl_VertexID & 1));
  vec2 place = u_box.xy + u_box.zw * cell / u_mapCells;
  flowtexPlaceOut = (u_flowMatrix * vec4(place, 0.0, 1.0)).xyw;
  gl_Position = projectTile(place);
}
`;var Ks=1e-5,Vt=Math.atan(Math.sinh(Math.PI))*180/Math.PI,q=Math.PI/180,Vo=88*q,qs='export it with projection="mercator"';
function de({lng:a,lat:e}){let t=Math.sin(_(e,-Vt,Vt)*q);return[a/360+.5,.5-Math.atanh(t)/(2*Math.PI)]}var Ut=class{origin;slope;box;constructor(e,t){
let r=e?.map;if(!r||!t)throw new Error(`the flow is not on a map; ${qs}`);this.box=r;let[n,s]=t.shape,i=(d,b)=>{let[g,y,
v]=t.data.subarray(3*(d*s+b)),x=de({lng:Math.atan2(y,g)/q,lat:Math.asin(v/Math.hypot(g,y,v))/q}),w=[r[0]+(r[2]-r[0])*b/(s-
1),r[1]+(r[3]-r[1])*d/(n-1)];return{place:x,position:w}},[o,c,l]=[i(1,1),i(n>>1,s>>1),i(n-2,s-2)],h=d=>d+Math.ceil(o.place[0]-
d),u=[h(l.place[0])-o.place[0],l.place[1]-o.place[1]];this.slope=[0,1].map(d=>u[d]/(l.position[d]-o.position[d])),this.origin=
[0,1].map(d=>o.place[d]-this.slope[d]*o.position[d]);let[m,p]=this.placeOf(c.position);if(!(Math.abs(m-h(c.place[0]))<Ks&&
Math.abs(p-c.place[1])<Ks))throw new Error(`the flow is on another map; ${qs}`)}placeOf(e){return[0,1].map(t=>this.origin[t]+
this.slope[t]*e[t])}lngLatOf(e){let[t,r]=this.placeOf(e);return[360*(t-.5),Math.atan(Math.sinh(2*Math.PI*(.5-r)))/q]}positionOf(e){
let[t,r]=e.map((s,i)=>(s-this.origin[i])/this.slope[i]),n=1/this.slope[0];return[t+n*Math.round((.5*(this.box[0]+this.box[2])-
t)/n),r]}look(e,t){let r=1/(512*2**e.zoom*this.slope[0]),[n,s]=this.positionOf(de(e.center)),i=f=>e.globe?this.globeLook(
e,r,[f,s,t]):this.flatLook(e,r,[f,s,t]),o=[i(n)],[c,l]=e.globe?[.5*r*o[0].width,.5*r*o[0].width]:[.5*r*Math.min(e.width,
e.height),r*Js(e)],[h,,u]=this.box,m=n+(n<.5*(h+u)?1:-1)/this.slope[0];return!(n-c<=h&&n+c>=u)&&Math.abs(m-_(m,h,u))<l&&
o.push(i(m)),o}flatLook({width:e,height:t,bearing:r,pitch:n,fov:s},i,[o,c,l]){let[h,u]=[r*q,n*q],m=.5*t*i,p=m/Math.tan(.5*
s*q);return{state:{position:[o-p*Math.sin(u)*Math.sin(h),c-p*Math.sin(u)*Math.cos(h),l+p*Math.cos(u)],focal_point:[o,c,l],
up:[Math.sin(h),Math.cos(h),0],parallel:n===0,parallel_scale:m,view_angle:s},width:e,height:t}}globeLook(e,t,[r,,n]){let s=1/
(t*this.slope[0]),i=_(e.center.lat,-Vt,Vt)*q,o=s/(2*Math.PI*Math.cos(i)),c=Math.asin(Math.min(Js(e)/o,1)),[l,h]=[i-c,i+c].
map(b=>de({lng:0,lat:b/q})[1]),u=Math.abs(i)+c<=Math.PI/2?Math.asin(Math.sin(c)/Math.cos(i)):Math.PI,m=(.5*(l+h)-this.origin[1])/
this.slope[1],[p,f]=[u/Math.PI,l-h];return{state:{position:[r,m,n+1/this.slope[0]],focal_point:[r,m,n],up:[0,1,0],parallel:!0,
parallel_scale:.5*f/this.slope[0],view_angle:e.fov},width:p*s,height:f*s}}};function Js({width:a,height:e,pitch:t,fov:r}){
let[n,s]=[t*q,.5*r*q],i=n+s;if(i>Vo)return 1/0;let c=.5*e/Math.tan(s)*Math.cos(n)*(Math.tan(i)-Math.tan(n));return Math.
hypot(c,.5*a*Math.cos(n)*Math.cos(s)/Math.cos(i))}var Fr=8192,Uo=22,Do=64,Dt=class{view;isUsed=!1;texture;shown=null;next=null;constructor(e,t){this.view=t,this.texture=e.
createTexture()}dispose(e){this.view.dispose(),e?.deleteTexture(this.texture)}follow(e,t){this.isUsed=this.view.isVisible=
e!==void 0,e?this.view.look(e.state,e.width,e.height,t):this.shown=this.next=null}painted(e){let{camera:t}=this.view;t&&
this.isUsed&&(this.next={camera:t,isComplete:e})}get isComplete(){let{view:e,next:t,shown:r}=this;return!this.isUsed||e.
sharp&&!t&&!!r?.isComplete&&!e.tiles?.pending}upload(e,t){if(this.next){e.pixelStorei(e.UNPACK_FLIP_Y_WEBGL,!0),e.pixelStorei(
e.UNPACK_PREMULTIPLY_ALPHA_WEBGL,!0),e.texImage2D(e.TEXTURE_2D,0,e.RGBA,e.RGBA,e.UNSIGNED_BYTE,this.view.canvas);for(let r of[
e.TEXTURE_WRAP_S,e.TEXTURE_WRAP_T])e.texParameteri(e.TEXTURE_2D,r,e.CLAMP_TO_EDGE);t&&e.generateMipmap(e.TEXTURE_2D),e.texParameteri(
e.TEXTURE_2D,e.TEXTURE_MIN_FILTER,t?e.LINEAR_MIPMAP_LINEAR:e.LINEAR),e.texParameteri(e.TEXTURE_2D,e.TEXTURE_MAG_FILTER,e.
LINEAR),this.shown=this.next,this.next=null}}draw(e){let{gl:t,programs:r,mercator:n,globe:s}=e,{vertexShaderPrelude:i,define:o}=e.
shaderData,c=r.get(`${o}
${i}
${Xs}`,Ys);if(!c.ready)return c.error;if(t.activeTexture(t.TEXTURE0),t.bindTexture(t.TEXTURE_2D,this.texture),this.upload(
t,s),!this.shown)return!0;let{camera:l}=this.shown,h=Math.floor(_(e.zoom,0,Uo)),u=n.placeOf(l.state.focal_point),m=2**h,
p=[Math.floor(u[0]*m),_(Math.floor(u[1]*m),0,m-1)],f=Math.floor(p[0]/m),d={z:h,x:p[0]-f*m,y:p[1]},b=T=>T.map((L,F)=>(L*m-
p[F])*Fr),[g,y,v,x]=n.box,[w,M]=[[g,y],[v,x]].map(T=>b(n.placeOf(T)));t.bindVertexArray(e.array);let A=s?Do:1,E=s?0:Math.
round(de(e.center)[0]-u[0]);for(let T of e.isRepeated&&!s?[-1,0,1]:[0]){let L={wrap:f+E+T,canonical:d},F=e.getProjectionData(
{tileID:L,applyGlobeMatrix:s});r.use(c,{u_projection_matrix:F.mainMatrix,u_projection_fallback_matrix:F.fallbackMatrix,u_projection_tile_mercator_coords:F.
tileMercatorCoords,u_projection_clipping_plane:F.clippingPlane,u_projection_transition:F.projectionTransition,u_box:[...w,
M[0]-w[0],M[1]-w[1]],u_mapCells:A,u_flowMatrix:Bo(this.view.header,l,n,p,1/(m*Fr)),u_flowPicture:0,u_opacity:e.opacity}),
t.drawArraysInstanced(t.TRIANGLE_STRIP,0,2*A+2,A)}return t.bindVertexArray(null),!0}};function Bo({geometry:a},e,t,r,n){
let{center:s,frame:i}=a,{focal_point:o}=e.state,c=N(i,S(o,s)),l=G(a,e,c),h=[0,1].map(f=>N(i,[0,1].map(d=>d===f?n/t.slope[f]:
0).concat(0))),u=t.placeOf(o),m=[0,1].map(f=>(r[f]*n*Fr-u[f])/t.slope[f]).concat(0);return[...h,[0,0,0],N(i,m)].flatMap(
(f,d)=>[0,1,2,3].map(b=>f.reduce((g,y,v)=>g+l[4*v+b]*y,d===3?l[12+b]:0)))}var Bt=class{atOnce=1;header;parts=[];tiles=new Map;known;texts;constructor(e,t,r,n){this.header=e,this.known=r,this.texts=
n;for(let s of t){let[{name:i,digest:o},c]=s,l=ue(i)?.[0];l?this.tiles.set(l,[...this.tiles.get(l)??[],s]):this.parts.push(
s),l&&c&&n.set(o,c)}}load=(e,t)=>{let r=((e&&this.tiles.get(B(e)))??[]).filter(([{name:n}])=>{let s=ue(n)?.[1]??"",i=K(s),
o=s.startsWith("scalars/")&&!Me(s,i,this.header);return Number.isNaN(i)||t.includes(i)||o});return Promise.all(r.map(n=>this.
unpacked(n)))};async unpacked([e,t]){let{digest:r,name:n}=e,s=this.known.get(r);return s?{...s,name:n}:Qr(e,t||(this.texts.
get(r)??""))}async kept(e){let t=await this.unpacked(e);return this.known.set(t.digest,t),t}};var Ce=class{};var be=class extends Error{},J=class extends be{_tag="NotFoundError";name="NotFoundError";path;found;constructor(e,t={}){
super(`Not found: ${e}`,{cause:t.cause}),this.path=t.path,this.found=t.found}},D=class extends be{_tag="InvalidMetadataE\
rror";name="InvalidMetadataError";path;constructor(e,t={}){super(e,{cause:t.cause}),this.path=t.path}},Ve=class extends be{_tag="\
UnknownCodecError";name="UnknownCodecError";codec;constructor(e){super(`Unknown codec: ${e}`),this.codec=e}},Ue=class extends be{_tag="\
CodecPipelineError";name="CodecPipelineError";direction;codec;chunkPath;constructor(e){let t=[`Failed to ${e.direction} \
chunk`,e.codec&&`via codec "${e.codec}"`,e.chunkPath&&`at ${e.chunkPath}`].filter(Boolean);super(t.join(" "),{cause:e.cause}),
this.direction=e.direction,this.codec=e.codec,this.chunkPath=e.chunkPath}};var ge=class extends be{_tag="UnsupportedError";name="UnsupportedError";feature;constructor(e){super(`Unsupported: ${e}`),
this.feature=e}};var De=class{},Be=class{},He=class{};function Qs(){if(typeof SharedArrayBuffer>"u")throw new Error("SharedArrayBuffer is not available. In browsers, this req\
uires Cross-Origin-Opener-Policy and Cross-Origin-Embedder-Policy headers to be set.")}function ea(a,e){return e?new SharedArrayBuffer(
a):new ArrayBuffer(a)}function ze(a){let e=new TextDecoder().decode(a);try{return JSON.parse(e)}catch(t){throw new D("Fa\
iled to decode JSON",{cause:t})}}function Nr(a,e){let t=e/2,r=e-1,n=0;for(let s=0;s<a.length;s+=e)for(let i=0;i<t;i+=1)n=
a[s+i],a[s+i]=a[s+r-i],a[s+r-i]=n}function zt(a){if(a==="v2:object")return globalThis.Array;let e=a.match(/v2:([US])(\d+)/);
if(e){let[,r,n]=e;return(r==="U"?He:Be).bind(null,Number(n))}if(a==="string")return globalThis.Array;let t={int8:Int8Array,
int16:Int16Array,int32:Int32Array,int64:globalThis.BigInt64Array,uint8:Uint8Array,uint16:Uint16Array,uint32:Uint32Array,
uint64:globalThis.BigUint64Array,float16:globalThis.Float16Array,float32:Float32Array,float64:Float64Array,bool:De}[a];if(!t)
throw new D(`Unknown or unsupported dataType: ${a}`);return t}function Gt(a,e){let t=a.length;typeof e=="string"&&(e=e===
"C"?Array.from({length:t},(s,i)=>i):Array.from({length:t},(s,i)=>t-1-i)),aa(t===e.length,"Order length must match the nu\
mber of dimensions.");let r=1,n=new Array(t);for(let s=e.length-1;s>=0;s--)n[e[s]]=r,r*=a[e[s]];return n}function ta({name:a,
configuration:e}){if(a==="default"){let t=e?.separator??"/";return r=>["c",...r].join(t)}if(a==="v2"){let t=e?.separator??
".";return r=>r.join(t)||"0"}throw new D(`Unknown chunk key encoding: ${a}`)}function Zs(a){if(a==="|O")return{dataType:"\
v2:object"};let e=a.match(/^([<|>])(.*)$/);if(!e)throw new D(`Invalid dtype: ${a}`);let[,t,r]=e,n={b1:"bool",i1:"int8",u1:"\
uint8",i2:"int16",u2:"uint16",i4:"int32",u4:"uint32",i8:"int64",u8:"uint64",f2:"float16",f4:"float32",f8:"float64"}[r]??
(r.startsWith("S")||r.startsWith("U")?`v2:${r}`:void 0);if(!n)throw new D(`Unsupported or unknown dtype: ${a}`);return t===
"|"?{dataType:n}:{dataType:n,endian:t==="<"?"little":"big"}}function Ho(a){return(a.id==="fixedscaleoffset"||a.id==="num\
codecs.fixedscaleoffset")&&typeof a.scale=="number"&&typeof a.offset=="number"&&(a.astype===void 0||typeof a.astype=="st\
ring")&&(a.dtype===void 0||typeof a.dtype=="string")}function ra(a,e={}){let t=[],r=Zs(a.dtype);a.order==="F"&&t.push({name:"\
transpose",configuration:{order:"F"}});for(let s of a.filters??[]){if(s.id==="fixedscaleoffset"||s.id==="numcodecs.fixed\
scaleoffset"){if(!Ho(s))throw new D(`Invalid fixedscaleoffset filter: ${JSON.stringify(s)}`);t.push({name:"scale_offset",
configuration:{scale:s.scale,offset:s.offset}});let c=s.astype??s.dtype;if(c!==void 0&&c!==a.dtype){let l=Zs(c).dataType;
if(!Ht(l,"number")&&!Ht(l,"bigint"))throw new D(`fixedscaleoffset astype must be a numeric data type, got ${c}`);t.push(
{name:"cast_value",configuration:{data_type:l,rounding:"nearest-even",out_of_range:"wrap"}})}continue}let{id:i,...o}=s;t.
push({name:`numcodecs.${i}`,configuration:o})}if("endian"in r&&r.endian==="big"&&t.push({name:"bytes",configuration:{endian:"\
big"}}),a.compressor){let{id:s,...i}=a.compressor;t.push({name:`numcodecs.${s}`,configuration:i})}let n;return globalThis.
Array.isArray(e._ARRAY_DIMENSIONS)&&(n=e._ARRAY_DIMENSIONS),{zarr_format:3,node_type:"array",shape:a.shape,data_type:r.dataType,
chunk_grid:{name:"regular",configuration:{chunk_shape:a.chunks}},chunk_key_encoding:{name:"v2",configuration:{separator:a.
dimension_separator??"."}},codecs:t,fill_value:a.fill_value,dimension_names:n,attributes:e}}function na(a,e={}){return{zarr_format:3,
node_type:"group",attributes:e}}function Ht(a,e){if(e!=="number"&&e!=="bigint"&&e!=="boolean"&&e!=="object"&&e!=="string")
return a===e;let t=a==="bool";if(e==="boolean")return t;let r=a.startsWith("v2:U")||a.startsWith("v2:S")||a==="string";if(e===
"string")return r;let n=a==="int64"||a==="uint64";if(e==="bigint")return n;let s=a==="v2:object";return e==="object"?s:!r&&
!n&&!t&&!s}function sa(a){return a?.name==="sharding_indexed"}function Wt(a){if((a.data_type==="uint64"||a.data_type==="\
int64")&&a.fill_value!=null)return BigInt(a.fill_value);let e=a.data_type==="float16"||a.data_type==="float32"||a.data_type===
"float64";if(typeof a.fill_value=="string"&&e){let t={NaN:NaN,Infinity:1/0,"-Infinity":-1/0};if(a.fill_value in t)return t[a.
fill_value]}return a.fill_value}function Ir(a,...e){if(!e.some(t=>a instanceof t))throw a}function aa(a,e=""){if(!a)throw new Error(e)}async function ia(a,{
format:e,signal:t}){let r;if(a instanceof ArrayBuffer)r=new Response(a);else{let n=new Uint8Array(a.buffer,a.byteOffset,
a.byteLength);r=new Response(n.slice().buffer)}aa(r.body,"Response does not contain body.");try{return await new Response(
r.body.pipeThrough(new DecompressionStream(e),{signal:t})).arrayBuffer()}catch{throw t?.throwIfAborted(),new Error(`Fail\
ed to decode ${e}`)}}var oa=zo();function zo(){let a=new Uint32Array([305419896]);return new Uint8Array(a.buffer,a.byteOffset,a.byteLength)[0]!==
18}function ca(a){return"BYTES_PER_ELEMENT"in a?a.BYTES_PER_ELEMENT:4}var Ge=class a{kind="array_to_bytes";#e;#t;#r;#s;#n;constructor(e,t){
this.#n=e?.endian,this.#t=zt(t.dataType),this.#s=t.shape,this.#e=Gt(t.shape,"C");let r=new this.#t(0);this.#r=r.BYTES_PER_ELEMENT}static fromConfig(e,t){
return new a(e,t)}encode(e){let t=new Uint8Array(e.data.buffer);return oa&&this.#n==="big"&&(t=t.slice(),Nr(t,ca(this.#t))),
t}computeEncodedSize(e){return e}decode(e){return oa&&this.#n==="big"&&(e=e.slice(),Nr(e,ca(this.#t))),e.byteOffset%this.#r!==
0&&(e=e.slice()),{data:new this.#t(e.buffer,e.byteOffset,e.byteLength/this.#r),shape:this.#s,stride:this.#e}}};var jt=class{};function $t(a){return()=>{throw new ge(`${a} encode`)}}var Yt=class a{kind="bytes_to_bytes";static fromConfig(){return new a}encode=$t("crc32c");decode(e){return new Uint8Array(
e.buffer,e.byteOffset,e.byteLength-4)}computeEncodedSize(e){return e+4}};var Xt=class{};var Kt=class a{kind="bytes_to_bytes";static fromConfig(e){return new a}encode=$t("gzip");async decode(e){let t=await ia(
e,{format:"gzip"});return new Uint8Array(t)}};var We=class{};var qt=class{};var Jt=class{};var Zt=class{};var je=class{};var Qt=class{};function Go(){let a=()=>import("numcodecs/blosc").then(s=>s.default),e=()=>import("numcodecs/lz4").then(s=>s.default),t=()=>import("numcodecs/zstd").
then(s=>s.default),r=()=>Kt,n=()=>Qt;return new Map().set("blosc",a).set("lz4",e).set("zstd",t).set("gzip",r).set("zlib",
n).set("transpose",()=>Zt).set("bytes",()=>Ge).set("crc32c",()=>Yt).set("vlen-utf8",()=>je).set("json2",()=>We).set("bit\
round",()=>Ce).set("cast_value",()=>jt).set("scale_offset",()=>qt).set("numcodecs.blosc",a).set("numcodecs.lz4",e).set("\
numcodecs.zstd",t).set("numcodecs.gzip",r).set("numcodecs.zlib",n).set("numcodecs.vlen-utf8",()=>je).set("numcodecs.shuf\
fle",()=>Jt).set("numcodecs.delta",()=>Xt).set("numcodecs.bitround",()=>Ce).set("numcodecs.json2",()=>We)}var $e=Go();function Ye(a){
let e;function t(){return e||(e=Wo(a)),e}async function r(n,s,i){try{return await i()}catch(o){throw new Ue({direction:n,
codec:s,cause:o})}}return{async encode(n){let s=await t();for(let{name:o,codec:c}of s.arrayToArray)n=await r("encode",o,
()=>c.encode(n));let i=await r("encode",s.arrayToBytes.name,()=>s.arrayToBytes.codec.encode(n));for(let{name:o,codec:c}of s.
bytesToBytes)i=await r("encode",o,()=>c.encode(i));return i},async decode(n){let s=await t();for(let o=s.bytesToBytes.length-
1;o>=0;o--){let{name:c,codec:l}=s.bytesToBytes[o];n=await r("decode",c,()=>l.decode(n))}let i=await r("decode",s.arrayToBytes.
name,()=>s.arrayToBytes.codec.decode(n));for(let o=s.arrayToArray.length-1;o>=0;o--){let{name:c,codec:l}=s.arrayToArray[o];
i=await r("decode",c,()=>l.decode(i))}return i},async computeEncodedSize(n){let s=await t(),i=la(s.arrayToBytes.name,s.arrayToBytes.
codec,n);for(let{name:o,codec:c}of s.bytesToBytes)i=la(o,c,i);return i}}}function la(a,e,t){if(!e.computeEncodedSize)throw new D(
`Codec "${a}" cannot compute its encoded size; it is not a fixed-size codec and cannot be used in a sharding index pipel\
ine`);return e.computeEncodedSize(t)}async function Wo(a){let e=a.codecs.map(async i=>{let o=await $e.get(i.name)?.();if(!o)
throw new Ve(i.name);return{Codec:o,meta:i}}),t=[],r,n=[],s={...a};for await(let{Codec:i,meta:o}of e){let c=i.fromConfig(
o.configuration,s);switch(c.kind){case"array_to_array":t.push({name:o.name,codec:c}),c.getEncodedMeta&&(s=c.getEncodedMeta(
s));break;case"array_to_bytes":r={name:o.name,codec:c};break;default:n.push({name:o.name,codec:c})}}if(!r){if(!jo(s))throw new D(
`Cannot encode ${s.dataType} to bytes without a codec`);r={name:"bytes",codec:Ge.fromConfig({endian:"little"},s)}}return{
arrayToArray:t,arrayToBytes:r,bytesToBytes:n}}function jo(a){return a.dataType!=="v2:object"&&a.dataType!=="string"}var ha=18446744073709551615n;function ma(a,e,t,r){if(!a.store.getRange)throw new ge("sharding requires a store with getR\
ange");let n=a.store.getRange.bind(a.store),s=e.map((l,h)=>l/r.chunk_shape[h]),i=Ye({dataType:"uint64",shape:[...s,2],codecs:r.
index_codecs,fillValue:null}),o=16*s.reduce((l,h)=>l*h,1),c={};return async(l,h)=>{let u=l.map((x,w)=>Math.floor(x/s[w])),
m=a.resolve(t(u)).path;m in c||(c[m]=(async()=>{let x=await i.computeEncodedSize(o),w=await n(m,{suffixLength:x},h);return w?
await i.decode(w):null})().catch(x=>{throw delete c[m],x}));let p=await c[m];if(p===null)return;let{data:f,shape:d,stride:b}=p,
g=l.map((x,w)=>x%d[w]).reduce((x,w,M)=>x+w*b[M],0),y=f[g],v=f[g+1];if(!(y===ha&&v===ha))return n(m,{offset:Number(y),length:Number(
v)},h)}}var se=class a{store;path;constructor(e,t="/"){this.store=e,this.path=t}resolve(e){let t=new URL(`file://${this.path.endsWith(
"/")?this.path:`${this.path}/`}`);return new a(this.store,decodeURIComponent(new URL(e,t).pathname))}};function tr(a){return new se(
a??new Map)}var ye=class extends se{kind="group";#e;constructor(e,t,r){super(e,t),this.#e=r}get attrs(){return this.#e.attributes}};
function ua(a){return a.find(t=>t.name==="transpose")?.configuration?.order??"C"}function $o(a,e){let t=new Map(e.map((r,n)=>[
r,n]));return a.filter(r=>t.has(r)).map(r=>t.get(r))}function pa(a){return(e,t)=>{let r=globalThis.Array.isArray(a)&&t?$o(
a,t):a;return Gt(e,r)}}var er=Symbol("zarrita.context");function Yo(a,e){let{configuration:t}=e.codecs.find(sa)??{},r={encodeChunkKey:ta(e.chunk_key_encoding),TypedArray:zt(e.data_type),
fillValue:e.fill_value};if(t){let s=ua(t.codecs);return{...r,kind:"sharded",chunkShape:t.chunk_shape,codec:Ye({dataType:e.
data_type,shape:t.chunk_shape,codecs:t.codecs,fillValue:e.fill_value}),getStrides:pa(s),getChunkBytes:ma(a,e.chunk_grid.
configuration.chunk_shape,r.encodeChunkKey,t)}}let n=ua(e.codecs);return{...r,kind:"regular",chunkShape:e.chunk_grid.configuration.
chunk_shape,codec:Ye({dataType:e.data_type,shape:e.chunk_grid.configuration.chunk_shape,codecs:e.codecs,fillValue:e.fill_value}),
getStrides:pa(n),async getChunkBytes(s,i){let o=r.encodeChunkKey(s),c=a.resolve(o).path;return a.store.get(c,i)}}}var le=class extends se{kind="\
array";#e;[er];constructor(e,t,r){super(e,t),this.#e={...r,fill_value:Wt(r)},this[er]=Yo(this,this.#e)}get attrs(){return this.#e.
attributes}get dimensionNames(){return this.#e.dimension_names}get fillValue(){return this.#e.fill_value}get shape(){return this.#e.
shape}get chunks(){return this[er].chunkShape}get dtype(){return this.#e.data_type}async getChunk(e,t,r){r?.useSharedArrayBuffer&&
Qs();let n=this[er],s=await n.getChunkBytes(e,t);if(!s){let i=n.chunkShape.reduce((c,l)=>c*l,1),o;if(r?.useSharedArrayBuffer){
let c=new n.TypedArray(0);if(!("BYTES_PER_ELEMENT"in c))console.warn("zarrita: useSharedArrayBuffer is not supported for\
 non-buffer-backed data types."),o=new n.TypedArray(i);else{let l=ea(i*c.BYTES_PER_ELEMENT,!0);o=new n.TypedArray(l,0,i)}}else
o=new n.TypedArray(i);return o.fill(n.fillValue),{data:o,shape:n.chunkShape,stride:n.getStrides(n.chunkShape)}}return n.
codec.decode(s)}is(e){return Ht(this.dtype,e)}};function fa(a,e){let t=a;for(let r of e)t instanceof Promise?t=t.then(n=>r(n)):t=r(t);return t}function da(a,...e){return fa(a,e)}async function ya(a){let e=a.store.arrayExtensions;return e?.length?await da(a,...e):a}var rr=Xo();function Xo(){let a=new WeakMap;
function e(t){let r=a.get(t)??{v2:0,v3:0};return a.set(t,r),r}return{increment(t,r){e(t)[r]+=1},versionMax(t){let r=e(t);
return r.v3>r.v2?"v3":"v2"}}}async function Ko(a,e){let t=await a.store.get(a.resolve(".zattrs").path,{signal:e});return t?
ze(t):{}}async function qo(a,e={}){let t="store"in a?a:new se(a),{signal:r}=e,n={};return(e.attrs??!0)&&(n=await Ko(t,r)),
r?.throwIfAborted(),e.kind==="array"?ba(t,n,r):e.kind==="group"?ga(t,n,r):ba(t,n,r).catch(s=>(Ir(s,J,D),ga(t,n,r)))}async function ba(a,e,t){
let{path:r}=a.resolve(".zarray"),n=await a.store.get(r,{signal:t});if(!n)throw new J("v2 array",{path:r});return rr.increment(
a.store,"v2"),ya(new le(a.store,a.path,ra(ze(n),e)))}async function ga(a,e,t){let{path:r}=a.resolve(".zgroup"),n=await a.
store.get(r,{signal:t});if(!n)throw new J("v2 group",{path:r});return rr.increment(a.store,"v2"),new ye(a.store,a.path,na(
ze(n),e))}async function Jo(a,e){let{store:t,path:r}=a.resolve("zarr.json"),n=await a.store.get(r,{signal:e});if(!n)throw new J(
"v3 array or group",{path:r});let s=ze(n);return s.node_type==="array"&&(s.fill_value=Wt(s)),s.node_type==="array"?ya(new le(
t,a.path,s)):new ye(t,a.path,s)}async function Zo(a,e={}){let t="store"in a?a:new se(a),r=await Jo(t,e.signal);if(rr.increment(
t.store,"v3"),e.kind===void 0||e.kind==="array"&&r instanceof le||e.kind==="group"&&r instanceof ye)return r;let n=r instanceof
le?"array":"group";throw new J(`${e.kind} at ${t.path}`,{path:t.path,found:n})}async function ee(a,e={}){let t="store"in
a?a.store:a,r=rr.versionMax(t),n=r==="v2"?ee.v2:ee.v3,s=r==="v2"?ee.v3:ee.v2;return n(a,e).catch(i=>(Ir(i,J,D),s(a,e)))}
ee.v2=qo;ee.v3=Zo;var va=[300,1e3,3e3],xa=2e4,ec=[401,403,404,410],Ma=200,tc=429,rc=500,nc=2197175160,Cr=4,sc=8,ac=1<<28,$=class extends Error{fault;detail;constructor(e,t,r=t){
super(t),this.fault=e,this.detail=r}},ic=Array.from({length:4},(a,e)=>Uint32Array.from({length:256},(t,r)=>{let n=r;for(let s=0;s<
8*(e+1);s+=1)n=n>>>1^(n&1?nc:0);return n}));function oc(a){let[e,t,r,n]=ic,s=a.length-a.length%4,i=4294967295;for(let o=0;o<
s;o+=4)i^=a[o]|a[o+1]<<8|a[o+2]<<16|a[o+3]<<24,i=n[i&255]^r[i>>>8&255]^t[i>>>16&255]^e[i>>>24];for(let o=s;o<a.length;o+=
1)i=i>>>8^e[(i^a[o])&255];return~i>>>0}async function Aa(a,e){let t=[],r=0,n=a?.getReader();try{for(;;){let{done:i=!0,value:o}=await n?.
read()??{};if(i||!o)break;t.push(o),r+=o.length,e(r)}}catch(i){throw n?.cancel().catch(()=>{}),i}let s=new Uint8Array(r);
return t.reduce((i,o)=>(s.set(o,i),i+o.length),0),s}var Vr=class a{kind="bytes_to_bytes";static fromConfig(){return new a}encode(){
throw new Error("nothing is written")}decode(e){let t=e.byteLength-Cr;if(t<0)throw new Error("the checksum is missing");
let{buffer:r,byteOffset:n}=e,s=new DataView(r,n+t,Cr).getUint32(0,!0),i=new Uint8Array(r,n,t);if(s!==oc(i))throw new Error(
"checksum mismatch");return i}computeEncodedSize(e){return e+Cr}},Ur=class a{kind="bytes_to_bytes";most;constructor(e){this.
most=e}static fromConfig(e,{shape:t}){return new a(Math.min(t.reduce((r,n)=>r*n,sc),ac))}encode(){throw new Error("nothi\
ng is written")}async decode(e){let t=new Blob([e]).stream();return Aa(t.pipeThrough(new DecompressionStream("gzip")),r=>{
if(r>this.most)throw new Error(`a chunk unpacks to more than ${this.most} bytes`)})}};$e.set("gzip",()=>Promise.resolve(
Ur));$e.set("crc32c",()=>Promise.resolve(Vr));function cc(a,e){return new Promise((t,r)=>{let n=()=>{clearTimeout(s),r(e.
reason)},s=setTimeout(()=>{e.removeEventListener("abort",n),t()},a);e.addEventListener("abort",n,{once:!0})})}async function lc(a,e){
let t=new AbortController,r=()=>t.abort();e.addEventListener("abort",r,{once:!0});let n=setTimeout(r,xa);try{e.throwIfAborted();
let{status:s,body:i}=await fetch(a,{signal:t.signal}),o=await Aa(s===Ma?i:null,()=>{clearTimeout(n),n=setTimeout(r,xa)});
return[s,o]}finally{t.abort(),clearTimeout(n),e.removeEventListener("abort",r)}}async function wa(a,e){for(let t=0;;t+=1){
let r="no server answers";try{let[n,s]=await lc(a,e);if(n===Ma)return s;if(ec.includes(n))return;if(r=`the server answer\
s ${n}`,n<rc&&n!==tc)throw new $("broken",r)}catch(n){if(e.throwIfAborted(),n instanceof $)throw n}if(t===va.length)throw new $(
"unreachable",r);await cc(va[t],e)}}var nr=class{url;described;shards=new Map;constructor(e,t){this.url=e,this.described=
t}get=async(e,t)=>e.endsWith("/zarr.json")?this.description(e):this.object(e,t?.signal);getRange=async(e,t,r)=>{let n=this.
shards.get(e)??this.object(e,r?.signal);this.shards.set(e,n);let s=await n;return"suffixLength"in t?s?.subarray(-t.suffixLength):
s?.subarray(t.offset,t.offset+t.length)};async object(e,t=new AbortController().signal){let r=await wa(this.url+e,t);if(!r)
throw new $("missing",`${e} is missing`);return r}description(e){let t=this.described.get(e);if(t)return t;let r=wa(this.
url+e,new AbortController().signal);return this.described.set(e,r),r.catch(()=>this.described.delete(e)),r}};function Ea(a){
if(a instanceof $)return a;let e=a instanceof J&&!a.found?"missing":"broken";return new $(e,a instanceof Error?a.message:
String(a))}var sr=class{url;described=new Map;constructor(e){this.url=e.replace(/\/+$/,"")}async attributes(){let e=new nr(
this.url,this.described);return(await ee.v3(tr(e),{kind:"group"})).attrs}async array(e){let t=new nr(this.url,this.described),
r=await ee.v3(tr(t).resolve(e),{kind:"array"});if(!r.is("number"))throw new $("broken",`${e} has no numbers`);return r}};var hc=64,mc=32,ar=4096,uc=2**28,pc=["padded","unit","open","nearest","normal","rays"],fc={missing:"it is not in the sto\
re, or the store is not public.",broken:"its data in the store are corrupt.",unreachable:"the store does not answer. The\
 server or the network may be down, or the server does not allow this page to read it (CORS)."},dc=["format","fingerprin\
t","parameter","lines"],ve=(a,e)=>Number.isInteger(a)&&Number(a)>0&&Number(a)<=e,Y=(a,e)=>Array.isArray(a)&&a.every(Number.
isFinite)&&(e??a.length)===a.length,bc=(a,e)=>Y(a,e)&&a.every(Number.isInteger);function gc({nodes:a,longest:e=0,poles:t=[]}){
return Number.isFinite(e)&&t.length<=2&&t.every(({component:r,line:n,inward:s,near:i,plane:o})=>[0,1].includes(r)&&r===t[0].
component&&n===(s>0?0:a[1-r]-1)&&[1,-1].includes(s)&&ve(i,ar)&&Y(o,6))}function yc(a,{geometry:e,slices:t}){let{geometry:r,
slices:n}=a,{shape:s,rows:i,columns:o}=r,{trace:c}=n;if(!(Y(s,2)&&s.every(h=>ve(h,ar)&&h>1)&&[i,o].every(({before:h,size:u},m)=>Number.
isInteger(h)&&ve(u,ar)&&h>=0&&h+s[m]<=u)&&Number.isInteger(r.levels)&&r.levels>=0&&2**r.levels<=Math.max(i.size,o.size)&&
r.triangles===e.triangles&&r.planar===e.planar&&Number.isFinite(r.extent)&&Y(r.periodic.map(Number),2)&&Y(r.center,3)&&Y(
r.frame,9)&&ve(n.count,hc)&&[2,4].includes(n.channels)&&Y(n.lags)&&ve(n.lags.length,mc)&&n.sides===t.sides&&Y(n.extra)&&
n.extra.every(h=>Number.isInteger(h)&&h>=0&&h<n.count)&&Y([n.unit,n.cell,n.critical])&&(!c||c.parts.every(h=>pc.includes(
h))&&Y(c.nodes,2)&&c.nodes.every((h,u)=>ve(h,ar)&&c.drawn[u]+s[u]<=h)&&bc([...c.first,...c.drawn],4)&&c.drawn.every(h=>h>=
0)&&Y(c.closed.map(Number),2)&&Y([...c.offset,...c.middle,c.unit,c.pace,c.rest],12)&&gc(c)&&(!c.timed||Y([c.timed.unit,c.
timed.speed],2)))))throw new Error("the header of a tile does not match the page")}function Ta({geometry:a,slices:e}){let{
shape:t,planar:r}=a,{trace:n,count:s,channels:i,extra:o}=e,c=(p,...f)=>[...p,...f].reduce((d,b)=>d*b,1),l=[a.rows.size,a.
columns.size],h=n?.nodes??[],u={cells:[Uint8Array,[c(t.map(p=>p-1))]],normal:[Int16Array,[c(t,3)]],scalars:[Float32Array,
[c(t)]]};if(n){u.unit=[Uint16Array,[c(h)]],u.padded=[Float32Array,[c(h.map(f=>f+2),3)]],u.open=[Uint8Array,[c(h)]],u.nearest=
[Int16Array,[c(h,2)]];let p=n.poles??[];u.rays=[Float32Array,[c(p.slice(0,1).map(f=>h[f.component]),2,p.length)]],u.flow=
[Uint16Array,n.uncertain?[c(h,5)]:[c(h,3),c(h,4)]]}else u.position=[Float32Array,[c(t,3)]],u.slices=[Uint16Array,[c(l,s,
i)]],u.extra=[Uint16Array,[c(l,o.length)]];let m=n?["mesh",...n.parts]:["mesh","position",...r?[]:["normal"]];return{sizes:u,
needed:m}}function Dr(a,e,t){let{sizes:r}=Ta(e),n=e.geometry.shape.map(s=>Math.ceil((s-1)/t));for(let{name:s,data:i,shape:o}of a){
let c=r[s.split("/")[0]];if(!(c?i instanceof c[0]&&c[1].includes(i.length):s==="mesh"&&i instanceof Float32Array&&o.length===
3&&o[0]===n[0]&&o[1]===n[1]&&i.length===o[0]*o[1]*o[2]))throw new Error(`the part "${s}" of a tile has a wrong size`)}}function vc(a,{
geometry:e,slices:t},r){let[n,s]=e.shape,[i,{drawn:o,nodes:c}={drawn:[0,0],nodes:[0,0]}]=[a.shape[2],t.trace],l=new Float32Array(
n*s);for(let h=0;h<l.length;h+=1){let u=(Math.floor(h/s)+o[0])*c[1]+h%s+o[1];l[h]=r*_e[Number(a.data[i*(u+1)-1-Number(t.
trace?.uncertain??!1)])]}return{name:"",data:l,shape:[n,s],digest:`${a.digest} speed`}}function Sa(a){let e=Ea(a);return e.
fault==="other"||e.detail!==e.message?e:new $(e.fault,fc[e.fault],e.message)}var ir=class{hasSteps=!0;atOnce=6;memory=18e7;header;told;url;store;headers=new Map;opening=null;constructor(e,t){
let r=e.store;if(!r)throw new Error("the page does not say where its store is");this.header=e,this.told=r,this.url=new URL(
r.url,t),this.store=new sr(this.url.href)}open(){return this.opening??=this.compare().catch(e=>{let t=Sa(e);throw t.fault===
"unreachable"&&(this.opening=null),t}),this.opening}async compare(){let{url:e}=this.told;if(!/^https?:/.test(this.url.protocol)){
let n=`This page reads its store from ${e} in the same folder, which browsers do not allow when the page is opened as a \
file: open it from a web server.`;throw new $("other",n)}let t=(await this.store.attributes()).flowtex;if(dc.every(n=>t?.[n]===
this.told[n]))return;let r=`The store at ${e} does not match this page: it has another flow, other paths or another vers\
ion: export the page again.`;throw new $("other",r)}load=async(e,t,r,n)=>{let s=e??[this.told.depth,0,0],i=B(s);return this.
loaded(r,async o=>{let c=t.filter(d=>!n(`slices/${d}`)&&!n(`flow/${d}`)),l=e?n("header")&&!c.length?this.headers.get(i):
void 0:this.header,h=l===void 0?this.surface(s,o):{header:l,parts:[]},u=new Map(c.map(d=>[d,this.flow(s,d,o)])),m=[...u.
values()],p=async()=>{let{header:d,parts:b}=await h;if(e&&this.headers.set(i,d),!d)return b;let[g,...y]=await Promise.all(
[this.values(s,d,t,n,o,u),...m]);if(Dr(y.flat(),d,this.header.mesh.tileCells),!y.every(v=>v.length))throw new Error(`til\
e ${i} has no flow`);return[...b,...y.flat(),...g]},[f]=await Promise.all([p(),...m]);return e?f.map(d=>({...d,name:`til\
e/${i}/${d.name}`})):f})};async loaded(e,t){let r=new AbortController;e.addEventListener("abort",()=>r.abort(),{once:!0});
try{return await this.open(),e.throwIfAborted(),await t(r.signal)}catch(n){throw e.throwIfAborted(),Sa(n)}finally{r.abort()}}async file(e,t,r,n){
let s=await this.store.array(`${t[0]}/${e}`),i=async f=>{let{data:d}=await s.getChunk([...r,f],{signal:n});if(!(d instanceof
Uint8Array))throw new Error(`${s.path} is empty`);return d},o=await i(0),[c,l]=mr(o),h=c.reduce((f,{bytes:d})=>f+d,l);if(!ve(
h,uc))throw new Error(`a file of ${s.path} has a wrong size`);let u=new Uint8Array(Math.ceil(h/o.length)*o.length);u.set(
o);for(let f=1;f*o.length<h;f+=1)u.set(await i(f),f*o.length);let m=new Map;for(let f of Zr(u.buffer)){let[d,b]=ue(f.name)??
["",f.name];if(d&&d!==B(t))throw new Error(`in place of tile ${B(t)} is ${d}`);m.set(b,{...f,name:b})}if(new TextDecoder().
decode(m.get("of")?.data)!==this.told.fingerprint)throw new Error(`tile ${B(t)} belongs to another flow`);return m.delete(
"of"),m}async surface(e,t){let r=await this.file("surface",e,[e[1],e[2]],t),n=this.tileHeader(r.get("header"));if(r.delete(
"header"),n){let o=Ta(n).needed.filter(c=>!r.has(c));if(o.length)throw new Error(`a tile has no ${o.join(", ")}`);Dr([...r.
values()],n,this.header.mesh.tileCells)}let s=new TextEncoder().encode(JSON.stringify(n)),i={name:"header",data:s,shape:[
s.length],digest:`${this.told.fingerprint} ${B(e)} header`};return{header:n,parts:[i,...r.values()]}}tileHeader(e){let t=JSON.
parse(new TextDecoder().decode(e?.data));if(t===null)return null;let{steps:r,times:n,timeUnit:s,dates:i,pace:o}=this.header.
slices;return yc(t,this.header),{...t,slices:{...t.slices,steps:r,times:n,timeUnit:s,dates:i,pace:o}}}async flow(e,t,r){
let n=this.told.steps[t];return[...(await this.file("flow",e,[n,e[1],e[2]],r)).values()].map(i=>{let[o,c]=i.name.split("\
/");if(Number(c)!==n)throw new Error(`in place of step ${n} is ${i.name}`);return{...i,name:`${o}/${t}`}})}async values(e,t,r,n,s,i){
let o=new Map;for(;;){let{name:c,steps:l,number:h}=this.header.scalars,m=(l>1?r:[0]).map(d=>h?`scalars/${d}/${h}`:`scala\
rs/${d}`),p=c===null?[]:m.filter(d=>!n(d)&&!o.has(d));if(!p.length)return[...o.values()];let f=await Promise.all(p.map(async d=>{
let b=l>1?K(d):0;if(!h&&this.told.derivesSpeed&&t.slices.trace){let[x]=await(i.get(b)??this.flow(e,b,s));return{...vc(x,
t,this.header.speed.typical),name:d}}let g=l>1?this.told.steps[b]:0,v=(await this.file("values",e,[g,e[1],e[2],h],s)).get(
`scalars/${g}/${h}`);if(!v)throw new Error(`tile ${B(e)} has no values of step ${g}`);return{...v,name:d}}));Dr(f,t,this.
header.mesh.tileCells);for(let d of f)o.set(d.name,d)}}};var xc=4096,wc=4,_a=32,Mc=.25,Ac=1e4,Pa=class{id;type="custom";renderingMode="2d";options;map=null;gl=null;programs=null;array=null;scene=null;pictures=[];look="";globe=!1;shownOpacity=1;close=null;asked=Promise.
resolve(null);own;colours={};constructor(e){this.options=e,this.own={...e.settings},this.id=e.id}onAdd(e,t){this.onRemove(),
this.map=e,this.gl=t;let r={context:t,counted:n=>n,free:()=>{}};this.programs=new Ae(r),this.array=t.createVertexArray(),
this.open(t).catch(n=>this.failed(n.message,""))}onRemove(){let{gl:e}=this;for(let t of this.pictures)t.dispose(e);this.
close?.then(t=>t.dispose()),this.close=null,e?.deleteVertexArray(this.array),this.programs?.dispose(),this.map=this.gl=this.
scene=null,[this.pictures,this.look]=[[],""]}async open(e){let{scene:t,opacity:r}=this.options,n=new URL(typeof t=="stri\
ng"?t:"",location.href).href,{headers:s,parts:i}=typeof t=="string"?await Ec(n):t;if(this.gl!==e)return;let o=Sc(s[0]),c=new Bt(
o,i.flatMap(([f,d,b])=>f?[]:[[d,b]]),new Map,new Map),l=o.store?new ir(o,n):c,h={header:o,settings:{...o.settings,...o.own,
...this.own},player:new ct};this.shownOpacity=r??s[0].opacity;let u=async(f,d)=>{let b=!0,g=new Ct(f,{...h,source:l,isComing:()=>b});
d(g);for(let y of c.parts){let v=await c.kept(y);if(g.lifetime.isOver)break;g.setPart(v)}return b=!1,Object.keys(this.colours).
length&&g.chooseColours(this.colours),g},m=()=>{let f=null;return u(this.hostOf(()=>f),d=>this.pictures.push(f=new Dt(e,
d)))},p=await m();this.gl===e&&(this.scene={...h,add:m,make:u,mercator:new Ut(o.earth,p.parts.get("lonlat"))},p.requests.
open(),this.options.onOpen?.(),this.map?.triggerRepaint())}hostOf=e=>({isHeld:()=>this.map?.isMoving()??!1,painted:t=>{e()?.
painted(t),this.map?.triggerRepaint()},advanced:()=>this.options.onTime?.(this.time),failed:(t,r)=>this.failed(t,r)});get time(){
let{varies:e=!1,time:t=0,clock:r=0}=this.scene?.player??{};return e?t:r}set time(e){let{player:t}=this.scene??{};t?.varies?
t.seek(e):t&&(t.clock=e),this.change()}get times(){return this.scene?.header.slices.times??[]}get bounds(){let{mercator:e}=this.
scene??{};if(!e)return null;let{box:t}=e;return[e.lngLatOf(t.slice(0,2)),e.lngLatOf(t.slice(2))]}get opacity(){return this.
shownOpacity}set opacity(e){this.shownOpacity=e,this.map?.triggerRepaint()}play(){let{player:e,settings:t}=this.scene??{};
!e||!t||(!e.varies&&t.motion==="off"&&(t.motion="speed"),e.start(),this.change())}pause(){this.scene&&(this.scene.player.
playing=!1),this.change()}set(e){Object.assign(this.own,e),Object.assign(this.scene?.settings??{},e),this.change()}setColours(e){
Object.assign(this.colours,e);for(let{view:t}of this.pictures)t.chooseColours(e)}change(){for(let{view:e}of this.pictures)
e.change()}async pointAt(e){let{mercator:t,header:r}=this.scene??{};if(!t||!r)return null;let n=[...t.positionOf(de(e)),
r.geometry.center[2]],s=this.pictures.filter(({isUsed:c})=>c).map(({view:c})=>c);await La(()=>s.every(({painter:c})=>c.canPick&&
c.shown));let i=s.map(c=>this.pointIn(c,n)).find(Boolean)??null;if(i&&!r.pyramid)return i;this.asked=this.asked.then(()=>this.
pointClose(n)).catch(()=>null);let o=await this.asked;return o&&{...o,path:i?.path??o.path}}pointIn(e,t){let{camera:r,parts:n,
settings:s}=e,{mercator:i}=this.scene??{},o=r?.project(t)??[2,2],c=Math.max(...o.map(Math.abs))>1?null:e.find(o[0],o[1]),
l=e.painter.shown;if(!i||!r||!c||!l)return null;let h=c.point.position,u={scene:c.layer.scene,moment:l,place:c.place,position:h},
[m,p]=ps(u,n.get("lonlat"))??[NaN,NaN],{path:f}=cs(u,s,r,e.rows);return{eastward:m,northward:p,values:c.point.values,path:f.
map(d=>i.lngLatOf(d))}}async pointClose(e){let{scene:t}=this;if(!t)return null;let r=!1,n={...this.hostOf(()=>null),painted:()=>{
r=!0},advanced:()=>{}},s=await(this.close??=t.make(n,f=>f.requests.open())),{box:i}=t.mercator,{pyramid:o,geometry:c}=t.
header,l=Mc*(i[2]-i[0])/(o?.shapes[0]??c.shape)[1],[h,u,m]=e,p={up:[0,1,0],view_angle:30,position:[h,u,m+l],focal_point:e,
parallel:!0,parallel_scale:l};return s.isVisible=!0,s.look(p,_a,_a,1),await La(()=>r&&s.painter.canPick&&!s.tiles?.pending&&
!s.tiles?.missing.length),s.isVisible=!1,this.pointIn(s,e)}failed(e,t){this.map?.fire("error",{error:new Error([e,t].filter(
Boolean).join(" "))})}render(e,t){let{map:r,scene:n,programs:s,array:i,opacity:o}=this;if(!r||!n||!s)return;let c=t.defaultProjectionData.
projectionTransition>0;this.follow(r,n,c);let[l,h]=[r.getZoom(),r.getCenter()],u=this.pictures.filter(({isUsed:d})=>d),{
shaderData:m,getProjectionData:p}=t,f={gl:e,programs:s,array:i,shaderData:m,getProjectionData:p,zoom:l,center:h,globe:c,
opacity:o};for(let d of u){let b=d.draw({...f,mercator:n.mercator,isRepeated:u.length===1});typeof b=="string"&&b?this.failed(
"The flow cannot be drawn on the map.",b):b!==!0&&r.triggerRepaint()}}follow(e,{mercator:t,header:r,add:n},s){let{what:i,
ratio:o,text:c}=Ra(e,s);if(c===this.look)return;let l=t.look(i,r.geometry.center[2]);l.length>this.pictures.length&&n(),
[0,1].forEach(h=>{let{width:u=1,height:m=1}=l[h]??{},p=Math.sqrt(wc*i.width*i.height/(u*m));this.pictures[h]?.follow(l[h],
Math.min(o,o*p,xc/Math.max(u,m)))}),this.look=c,this.globe=s}get isComplete(){let{map:e,pictures:t}=this;return!e||!this.
scene||!t.every(r=>r.isComplete)?!1:this.look===Ra(e,this.globe).text}};function Ra(a,e){let{clientWidth:t,clientHeight:r}=a.
getCanvas(),n={center:a.unproject([t/2,r/2]),width:t,height:r,zoom:a.getZoom(),bearing:a.getBearing(),pitch:a.getPitch(),
fov:a.getVerticalFieldOfView(),globe:e},s=a.getPixelRatio();return{what:n,ratio:s,text:JSON.stringify([n,s])}}async function La(a){
let e=performance.now()+Ac;for(;!a()&&performance.now()<e;)await new Promise(requestAnimationFrame)}async function Ec(a){
let e=await fetch(a);if(!e.ok)throw new Error(`the scene ${a} cannot be read: the server answers ${e.status}`);return await e.
json()}function Sc(a){let{earth:e}=a;return{...a,background:[0,0,0],opacity:1,earth:e&&{...e,...{land:null,coastlines:!1,
graticule:!1}}}}export{Pa as FlowtexLayer};
